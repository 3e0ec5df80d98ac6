// SPDX-License-Identifier: Apache-2.0
// A cube of fog lit from one side: the zonal method against path tracing.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "render/zonal/cube.h"
#include "render/zonal/first_light.h"
#include "render/zonal/zone_light.h"
#include "render/zonal/zone_solver.h"

namespace gischt {
namespace {

using namespace path_test;

// What leaves the zones, by face.
CubeFaces by_zones(double thickness, int zones, int lines) {
    const View view = lit_cube(thickness);
    Job job;
    Enclosure e;
    e.grid = make_zones(view.media, {Vec3d(-0.5), Vec3d(0.5)}, Vec3i(zones), 1,
                        ZoneScattering::Plain, job);
    e.lines = lines;
    const std::vector<Vec3f> first = FirstLight(view, e.grid, 64).mean_radiance(job);
    std::vector<Vec3f> source(e.elements());
    for (std::size_t i = 0; i < source.size(); ++i) source[i] = e.grid.scattering[i] * first[i];
    const ZoneSweep sweep(e, job);
    const ZoneSolution light =
        solve_zones(sweep, source, ZoneSolver::Sweeps, {.tolerance = 1e-4}, job);
    std::array<double, 6> face{};
    for (int side = 0; side < 6; ++side) {
        for (std::size_t i = e.first_side_cell(side); i < e.first_side_cell(side + 1); ++i) {
            face[static_cast<std::size_t>(side)] += double(light.leaving[i].x) / pi;
        }
    }
    return {face[0], face[1], 0.25 * (face[2] + face[3] + face[4] + face[5])};
}

TEST(ZonalCube, FacesLeaveWhatPathTracingSays) {
    const CubeReference& r = cube_references[0];
    expect_faces(by_zones(r.thickness, 12, 16), r.mean, 0.03, "tau 4");
}

TEST(ZonalCube, GatheredFacesAreThoseOfPathTracing) {
    for (const auto& [index, zones] : {std::pair{0, 12}, {1, 32}}) {
        const CubeReference& r = cube_references[static_cast<std::size_t>(index)];
        const View view = lit_cube(r.thickness);
        ZonalParams params;
        params.zones = zones;
        params.lines = 8;
        Job job;
        const auto source = light_of_zones(view, {Vec3d(-0.5), Vec3d(0.5)}, params, job);
        const CubeFaces got = gathered_faces(view, *source, 1 << 14);
        expect_faces(got, r.mean, 0.03, fmt::format("tau {}", r.thickness));
    }
}

TEST(ZonalCubeLong, FacesLeaveWhatPathTracingSays) {
    for (const CubeReference& r : cube_references) {
        for (const int zones : {8, 12, 16, 24, 32, 40}) {
            const double start = now_seconds();
            const CubeFaces f = by_zones(r.thickness, zones, 16);
            fmt::print("| {} | {} | {:+.1f} % | {:+.1f} % | {:+.1f} % | {:.2f} |\n", r.thickness,
                       zones, 100 * (f.lit / r.mean.lit - 1), 100 * (f.back / r.mean.back - 1),
                       100 * (f.side / r.mean.side - 1), now_seconds() - start);
            if (zones == 40) expect_faces(f, r.mean, 0.03, fmt::format("tau {}", r.thickness));
        }
    }
}

// Where the reference comes from: 0.5 million paths per face. It is met within what chance allows.
TEST(ZonalCubeLong, ReferenceIsThatOfPathTracing) {
    for (const CubeReference& r : cube_references) {
        const View view = lit_cube(r.thickness);
        Traced traced(view, {}, 10'000);
        const auto face = [&](int axis, int end) {
            return cube_face(axis, end, 64, 8192, traced.seen());
        };
        const Estimate lit = face(0, 0), back = face(0, 1), side = face(1, 0);
        fmt::print("tau {}: lit {:.6f} +- {:.6f} back {:.6f} +- {:.6f} side {:.6f} +- {:.6f}\n",
                   r.thickness, lit.mean.x, lit.error.x, back.mean.x, back.error.x, side.mean.x,
                   side.error.x);
        const double z = critical_z(6, 64);
        EXPECT_NEAR(lit.mean.x, r.mean.lit, z * (lit.error.x + r.error.lit));
        EXPECT_NEAR(back.mean.x, r.mean.back, z * (back.error.x + r.error.back));
        EXPECT_NEAR(side.mean.x, r.mean.side, z * (side.error.x + r.error.side));
    }
}

}  // namespace
}  // namespace gischt
