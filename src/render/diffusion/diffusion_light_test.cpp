// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "render/diffusion/diffusion_light.h"
#include "render/zonal/cube.h"

namespace gischt {
namespace {

using namespace path_test;

TEST(DiffusionCube, GatheredFacesAreThoseOfPathTracing) {
    for (const CubeReference& r : cube_references) {
        const View view = lit_cube(r.thickness);
        DiffusionParams params;
        params.resolution = 48;
        Job job;
        const auto source = light_by_diffusion(view, {Vec3d(-0.5), Vec3d(0.5)}, params, job);
        const CubeFaces got = gathered_faces(view, *source, 1 << 14);
        expect_faces(got, r.mean, 0.10, fmt::format("tau {}", r.thickness));
    }
}

// Power in the middle of a long thin box with black ends: between the ends the fluence is the
// solution of an ordinary equation, in one dimension when the box is wide.
TEST(Diffusion, PowerThatIsEverywhereLeavesOrIsAbsorbed) {
    DiffusionProblem p;
    p.grid = ZoneGrid::even({{0, 0, 0}, {1, 1, 1}}, Vec3i(24), 8, 0.9f);
    p.transport_extinction = p.grid.extinction;
    p.power.assign(p.grid.size(), Vec3f(1));
    for (auto& m : p.moment) m.resize(p.grid.size());
    Job job;
    const DiffuseLight light = diffuse_light(p, 1e-6, job);
    // All that is given is absorbed, or leaves by the faces.
    const double h = 1.0 / 24, d = (0.8 + 8) / (3.0 * 64);
    double absorbed = 0, left = 0;
    for (std::size_t i = 0; i < p.grid.size(); ++i) {
        const Vec3i c = p.grid.cell(i);
        const double phi = double(light.fluence[i].x);
        absorbed += 0.8 * phi * h * h * h;
        int faces = 0;
        for (int a = 0; a < 3; ++a) faces += c[a] == 0 || c[a] == 23 ? 1 : 0;
        // Edges and corners count as if they were rounded off.
        left += std::sqrt(faces) * h * h * d * phi / (0.7104 / 8 + 0.5 * h);
    }
    EXPECT_NEAR(absorbed + left, 1, 1e-4);
}

// In a layer, phi = c cosh(k (z - 1/2)) + power / a with phi = z F n / D at its ends.
TEST(Diffusion, LayerIsTheSolutionOfTheEquation) {
    const double a = 1, s = 9, total = a + s, d = (2 * a + s) / (3 * total * total),
                 k = std::sqrt(a / d);
    const double z = 0.7104 / total;
    const double c = -1 / a / (std::cosh(0.5 * k) + z * k * std::sinh(0.5 * k));
    double error[2];
    int run = 0;
    for (const int n : {16, 32}) {
        DiffusionProblem p;
        // Wide: eight times as wide as thick, sampled in the middle.
        p.grid = ZoneGrid::even({{-2, -2, 0}, {2, 2, 1}}, {4 * n, 4 * n, n}, 10, 0.9f);
        p.transport_extinction = p.grid.extinction;
        p.power.assign(p.grid.size(), Vec3f(1));
        for (auto& m : p.moment) m.resize(p.grid.size());
        Job job;
        const DiffuseLight light = diffuse_light(p, 1e-6, job);
        error[run] = 0;
        for (int layer = 0; layer < n; ++layer) {
            const double at = (layer + 0.5) / n;
            const double truth = c * std::cosh(k * (at - 0.5)) + 1 / a;
            const double phi = double(light.fluence[p.grid.index({2 * n, 2 * n, layer})].x);
            error[run] = std::max(error[run], std::abs(phi - truth) / truth);
        }
        ++run;
    }
    EXPECT_LT(error[1], 0.005);
    EXPECT_GT(error[0] / error[1], 2.8);  // second order
}

TEST(Diffusion, ThreadsDoNotMatter) {
    const View view = lit_cube(6);
    DiffusionParams params;
    params.resolution = 16;
    Job job;
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return diffuse_light(diffusion_problem(view, {Vec3d(-0.5), Vec3d(0.5)}, params, job), 1e-5,
                             job)
            .fluence;
    };
    EXPECT_EQ(run(1), run(4));
}

TEST(Diffusion, SurfacesAmongTheMediaAreRefused) {
    View view = lit_cube(6);
    SphereSurface ball;
    ball.radius = Keyed<double>(0.2);
    view.surfaces = SurfaceSet({ball}, 0);
    Job job;
    EXPECT_THROW(light_by_diffusion(view, {Vec3d(-0.5), Vec3d(0.5)}, {}, job), Error);
}

}  // namespace
}  // namespace gischt
