// SPDX-License-Identifier: Apache-2.0
// The white furnace: where nothing absorbs and everything is lit evenly by 1, everything is 1.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "optics/surface_rig.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

constexpr int no_limit = 100'000'000;  // scatterings

LightPtr white() {
    return sky(Vec3f(1));
}
// The same as a picture: directions are drawn from it, and weighed against scattering.
LightPtr white_map() {
    return std::make_shared<EnvironmentLight>(
        std::make_shared<EnvironmentMap>(16, 8, [](const Vec3d&) { return Vec3f(1); }), Transform{},
        Vec3f(1));
}

MediumParams white_medium(PhaseKind phase, double g) {
    MediumParams p = coefficients(Vec3d(1), Vec3d(1), g);
    p.phase = phase;
    return p;
}

// Blocks of 4^3 voxels of [-1,1]^3: a third of them empty, the others of an even extinction
// between two powers of ten per voxel, and a noise of random voxels on top.
MediumPtr blocks(int n, double low, double high, const MediumParams& params, std::uint64_t seed) {
    const auto value = [=](const Vec3d& p) {
        const auto cell = [&](double x) { return static_cast<std::uint64_t>((x + 1) / 2 * n); };
        const std::uint64_t i = cell(p.x), j = cell(p.y), k = cell(p.z);
        const std::uint64_t block = random_key(seed, i / 4, j / 4, k / 4);
        if (random_uniform(block, 0) < 1.0f / 3) return 0.0;
        const double power = low + (high - low) * double(random_uniform(block, 1));
        const double grain = double(random_uniform(random_key(seed, i, j, k), 7));
        return std::pow(10, power) * (0.5 + grain) * n / 2;
    };
    return voxels(n, value, params);
}

// Each of 4x4 pixels by itself.
void expect_white(const View& view, const std::string& name, int batches = 32, int samples = 4,
                  const PathParams& params = {}, double rounding = 2e-5) {
    constexpr int edge = 4;
    Traced traced(view, params, no_limit);
    for (int pixel = 0; pixel < edge * edge; ++pixel) {
        const int x = pixel % edge, y = pixel / edge;
        const Estimate got =
            mean_of_part(view, traced.seen(), x, y, edge, {.batches = batches, .samples = samples});
        for (int c = 0; c < 3; ++c) {
            expect_mean(got, c, 1, 3 * edge * edge, fmt::format("{} pixel {} {}", name, x, y),
                        rounding);
        }
    }
}

struct PhaseCase {
    PhaseKind kind;
    double g;
};
constexpr PhaseCase phases[] = {
    {PhaseKind::Isotropic, 0},          {PhaseKind::HenyeyGreenstein, -0.9},
    {PhaseKind::HenyeyGreenstein, 0.5}, {PhaseKind::HenyeyGreenstein, 0.95},
    {PhaseKind::Schlick, 0.7},          {PhaseKind::Rayleigh, 0},
    {PhaseKind::TwoLobe, 0.8},          {PhaseKind::Mie, 0},
};

TEST(PathFurnace, IsWhiteForAllPhaseFunctions) {
    for (const PhaseCase& p : phases) {
        View view;
        view.camera = ortho({3, 2, 1.5}, 2.6);
        view.media = {blocks(16, -2, 0.5, white_medium(p.kind, p.g), 5)};
        for (const LightPtr& light : {white(), white_map()}) {
            view.lights = {light};
            expect_white(view, fmt::format("phase {} g {}", static_cast<int>(p.kind), p.g));
        }
    }
}

TEST(PathFurnace, IsWhiteForThinAndThickMedia) {
    PathParams tracking;
    tracking.camera = CameraSegment::Tracking;
    for (const auto& [low, high] : {std::pair{-3.0, -2.0}, std::pair{-3.0, 3.0}}) {
        View view;
        view.camera = ortho({1, 3, 2}, 2.6);
        view.lights = {white()};
        view.media = {blocks(16, low, high, white_medium(PhaseKind::HenyeyGreenstein, 0.8), 9)};
        expect_white(view, fmt::format("1e{} to 1e{}", low, high), 32, 2);
        expect_white(view, fmt::format("tracking, 1e{} to 1e{}", low, high), 32, 2, tracking);
    }
}

TEST(PathFurnace, IsWhiteInsideOfOverlappingMediaOfManyColors) {
    MediumParams red = white_medium(PhaseKind::HenyeyGreenstein, 0.6),
                 blue = white_medium(PhaseKind::HenyeyGreenstein, -0.4);
    red.extinction = Keyed<Vec3d>(Vec3d(0.3, 1, 2));
    blue.extinction = Keyed<Vec3d>(Vec3d(3, 1, 0));
    View view;
    // From within.
    CameraParams camera;
    camera.position = Keyed<Vec3d>(Vec3d(0.1, 0.2, 0.3));
    camera.target = Keyed<Vec3d>(Vec3d(1, -0.4, 0.2));
    view.camera = Camera(camera, 0, 1, 1);
    view.media = {blocks(16, -2, 0, red, 1), blocks(16, -2, 0, blue, 2)};
    for (const LightPtr& light : {white(), white_map()}) {
        view.lights = {light};
        PathParams params;
        for (const CameraSegment segment : {CameraSegment::Profile, CameraSegment::Tracking}) {
            params.camera = segment;
            for (const int points : {1, 3, 4}) {
                params.points = points;
                if (segment == CameraSegment::Tracking && points > 1) continue;
                expect_white(
                    view,
                    fmt::format("{} {} points",
                                segment == CameraSegment::Profile ? "profile" : "tracking", points),
                    48, 8, params);
            }
        }
    }
}

// A white ball in a cloud, and both in a ball of glass that the cloud fills.
TEST(PathFurnace, IsWhiteAroundAndBehindSurfaces) {
    SphereSurface ball, glass;
    ball.radius = Keyed<double>(0.4);
    ball.center = Keyed<Vec3d>(Vec3d(0.2, 0.1, -0.3));
    ball.material.albedo = Vec3d(1);
    ball.material.checker = Vec3d(1);
    glass.radius = Keyed<double>(1.1);
    glass.material.kind = MaterialKind::Dielectric;
    glass.material.interior = "cloud";
    const MediumPtr cloud = blocks(16, -2, 0.3, white_medium(PhaseKind::HenyeyGreenstein, 0.7), 3);
    View view;
    view.camera = ortho({-2, 3, 1}, 2.8);
    view.media = {cloud};
    const auto set = [&](const std::vector<SurfaceParams>& solids) {
        Job job;
        view.surfaces = SurfaceRig(solids, {}, {0, 0, 1}, {}, {}, job).at(0, 0, {{"cloud", cloud}});
    };
    for (const LightPtr& light : {white(), white_map()}) {
        view.lights = {light};
        set({ball});
        expect_white(view, "white ball");
        glass.material.roughness = 0;
        set({ball, glass});
        expect_white(view, "ball in smooth glass");
        glass.material.kind = MaterialKind::None;
        set({ball, glass});
        expect_white(view, "ball in a boundary without a surface");
        glass.material.kind = MaterialKind::Dielectric;
    }
    // What light does between the facets of rough glass is known from tables, within 1e-3.
    for (const double roughness : {0.2, 0.6}) {
        glass.material.roughness = roughness;
        set({ball, glass});
        expect_white(view, fmt::format("ball in glass of roughness {}", roughness), 32, 4, {},
                     2e-3);
    }
}

// With less than all light scattered, and less than all of the sky lit, no more than 1 comes back.
TEST(PathFurnace, NeverGivesMoreThanItGets) {
    for (const double albedo : {0.2, 0.9, 1.0}) {
        View view;
        view.camera = ortho({3, -2, 1}, 2.2);
        view.media = {voxels(
            16, [](const Vec3d& p) { return lumps(p); },
            coefficients({10, 20, 40}, Vec3d(albedo), 0.85))};
        view.lights = {std::make_shared<EnvironmentLight>(
            std::make_shared<EnvironmentMap>(
                32, 16, [](const Vec3d& d) { return Vec3f(d.x + d.z > 0 ? 1.0f : 0.2f); }),
            Transform{}, Vec3f(1))};
        const Estimate got = mean_radiance(view, {}, {.depth = no_limit});
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(got.mean[c], 1 + critical_z(9, got.batches) * got.error[c]) << albedo;
            EXPECT_GT(got.mean[c], 0.05) << albedo;
        }
    }
}

}  // namespace
}  // namespace gischt
