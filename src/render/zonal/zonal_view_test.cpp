// SPDX-License-Identifier: Apache-2.0
// Whole pictures by zones and by diffusion against path tracing, and what is refused.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "optics/light_params.h"
#include "render/diffusion/diffusion.h"
#include "render/path/path.h"
#include "render/path/test_views.h"
#include "render/zonal/zonal.h"

namespace gischt {
namespace {

using namespace path_test;

Image picture(RenderMethod& method, const View& view, int samples) {
    RenderSettings settings;
    settings.samples_per_pixel = samples;
    settings.depth = 10'000;
    Job job;
    return method.render(view, settings, job).image;
}
Vec3d mean_of(const Image& image) {
    Vec3d sum;
    int c = 0;
    for (const char* name : {"R", "G", "B"}) {
        for (const float v : image.channel(name)) sum[c] += double(v);
        ++c;
    }
    return sum / Vec3d(static_cast<double>(image.pixel_count()));
}
void expect_close(const Image& got, const Image& truth, double share, const std::string& name) {
    const Vec3d a = mean_of(got), b = mean_of(truth);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1, share) << name << " channel " << c;
}

ZonalParams zonal(int zones, ZonalSolver solver = ZonalSolver::Auto) {
    ZonalParams p;
    p.zones = zones;
    p.solver = solver;
    return p;
}

View cloud(double extinction, double albedo, double g) {
    View view;
    view.camera = ortho({1, -4, 1}, 1.8, 12);
    view.media = {voxels(
        24, [](const Vec3d& p) { return lumps(p); },
        coefficients(Vec3d(extinction), Vec3d(albedo), g))};
    view.lights = {delta_sun({-0.6, -0.5, 0.7}, Vec3f(3, 2, 1))};
    view.background = Vec3f(0);
    return view;
}

// Where everything shines with 1 and nothing is absorbed, all of the picture is 1. The similarity
// relation loses what is scattered forward twice of the light straight behind.
TEST(ZonalView, WhiteFurnaceIsWhite) {
    for (const auto& [g, share] : {std::pair{0.0, 0.02}, {0.6, 0.1}}) {
        View view = cloud(6, 1, g);
        view.lights = {sky(Vec3f(1))};
        view.background.reset();
        const Image image = picture(*make_zonal_method(zonal(16)), view, 64);
        const Vec3d mean = mean_of(image);
        EXPECT_NEAR(mean.x, 1, share) << g;
    }
}

TEST(ZonalView, CloudIsThatOfPathTracing) {
    const View view = cloud(6, 0.95, 0);
    const Image truth = picture(*make_path_method({}), view, 64);
    expect_close(picture(*make_zonal_method(zonal(20)), view, 16), truth, 0.03, "even");
}

// The similarity relation holds in thick media only; ordinates know the phase function.
TEST(ZonalView, ForwardScatteringCloudIsAboutThatOfPathTracing) {
    const View view = cloud(6, 0.95, 0.6);
    const Image truth = picture(*make_path_method({}), view, 64);
    expect_close(picture(*make_zonal_method(zonal(12)), view, 16), truth, 0.10, "similarity");
}
TEST(ZonalViewLong, ForwardScatteringCloudIsNearlyThatOfPathTracing) {
    const View view = cloud(6, 0.95, 0.6);
    const Image truth = picture(*make_path_method({}), view, 64);
    expect_close(picture(*make_zonal_method(zonal(16)), view, 16), truth, 0.10, "similarity");
    expect_close(picture(*make_zonal_method(zonal(16, ZonalSolver::Ordinates)), view, 16), truth,
                 0.04, "ordinates");
}

// Matrix and sweeps are two ways to the same light.
TEST(ZonalView, SolversAgree) {
    const View view = cloud(5, 0.9, 0.3);
    const Image a = picture(*make_zonal_method(zonal(12, ZonalSolver::Exchange)), view, 4),
                b = picture(*make_zonal_method(zonal(12, ZonalSolver::Sweeps)), view, 4);
    expect_close(a, b, 1e-3, "solvers");
}

// Walls and a ball in mist, sun and sky: what surfaces give to the mist and the mist to them.
View room() {
    View view;
    view.camera = ortho({0, -4, 2}, 2.0, 16);
    view.media = {
        solid(Region::box({{-1, -1, -1}, {1, 1, 1}}), coefficients(Vec3d(0.8), Vec3d(0.95)))};
    BoxSurface floor, wall;
    floor.center = Keyed<Vec3d>(Vec3d(0, 0, -1.1));
    floor.size = {2.4, 2.4, 0.2};
    floor.material.albedo = Vec3d(0.8, 0.8, 0.8);
    wall.center = Keyed<Vec3d>(Vec3d(1.1, 0, 0));
    wall.size = {0.2, 2.2, 2.2};
    wall.material.albedo = Vec3d(0.8, 0.3, 0.1);
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(-0.1, 0.1, -0.4));
    ball.radius = Keyed<double>(0.4);
    ball.material.albedo = Vec3d(0.7, 0.7, 0.7);
    view.surfaces = SurfaceSet({floor, wall, ball}, 0);
    view.lights = {delta_sun({-0.5, -0.4, 0.8}, Vec3f(3)), sky(Vec3f(0.2f))};
    view.background = Vec3f(0);
    return view;
}

TEST(ZonalView, RoomOfMistIsThatOfPathTracing) {
    const View view = room();
    const Image truth = picture(*make_path_method({}), view, 64);
    ZonalParams params = zonal(12);
    params.surfaces = true;
    expect_close(picture(*make_zonal_method(params), view, 16), truth, 0.04, "room");
}
TEST(ZonalViewLong, RoomOfMistByFinerZonesAndByOrdinatesIsThatOfPathTracing) {
    const View view = room();
    const Image truth = picture(*make_path_method({}), view, 256);
    ZonalParams even = zonal(18), ordinates = zonal(12, ZonalSolver::Ordinates);
    even.surfaces = ordinates.surfaces = true;
    expect_close(picture(*make_zonal_method(even), view, 16), truth, 0.03, "room");
    expect_close(picture(*make_zonal_method(ordinates), view, 16), truth, 0.04,
                 "room by ordinates");
}

TEST(ZonalView, ThreadsDoNotMatter) {
    const View view = room();
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return mean_of(picture(*make_zonal_method(zonal(8)), view, 1));
    };
    EXPECT_EQ(run(1), run(3));
}

// What is thick and bright; soft edges, in which light does not diffuse, come out too dark.
TEST(DiffusionViewLong, DenseMediaAreNearlyThoseOfPathTracing) {
    View ball = cloud(20, 0.99, 0);
    ball.media = {solid(Region::sphere({0, 0, 0}, 1), coefficients(Vec3d(20), Vec3d(0.99)))};
    expect_close(picture(*make_diffusion_method({}), ball, 16),
                 picture(*make_path_method({}), ball, 16), 0.06, "ball");
    const View lump = cloud(20, 0.99, 0);
    expect_close(picture(*make_diffusion_method({}), lump, 16),
                 picture(*make_path_method({}), lump, 16), 0.25, "lump");
}

template <class Make>
void expect_refused(const Make& make, const View& view, std::string_view what,
                    std::string_view instead) {
    try {
        picture(*make(), view, 1);
        ADD_FAILURE() << "not refused: " << what;
    } catch (const Error& e) {
        EXPECT_NE(e.fact().find(what), std::string::npos) << e.what();
        EXPECT_NE(e.hint().find(instead), std::string::npos) << e.what();
    }
}

TEST(ZonalView, WhatItCannotDoIsRefusedByName) {
    const auto zones = [] { return make_zonal_method(zonal(8)); };
    const auto diffusion = [] { return make_diffusion_method({}); };
    View view = cloud(5, 0.9, 0);
    view.media.push_back(solid(Region::everywhere(), coefficients(Vec3d(0.1), Vec3d(0.5))));
    expect_refused(zones, view, "no end", "'path'");
    expect_refused(diffusion, view, "no end", "'path'");
    view = cloud(5, 0.9, 0);
    view.media.clear();
    expect_refused(zones, view, "no medium", "'path'");
    view = cloud(5, 0.9, 0);
    view.moving_media = {view.media, view.media};
    expect_refused(zones, view, "moves", "shutter");
    expect_refused(zones, cloud(60, 0.9, 0), "thick", "zones to");
    expect_refused(zones, cloud(2000, 0.9, 0), "thick", "'diffusion'");
    view = room();
    SphereSurface glass;
    glass.name = "lens";
    glass.material.kind = MaterialKind::Dielectric;
    view.surfaces = SurfaceSet({glass}, 0);
    expect_refused(zones, view, "lens", "'path'");
    expect_refused(diffusion, room(), "stands", "'zonal'");
    ZonalParams small = zonal(24, ZonalSolver::Exchange);
    small.memory_limit = 1;
    expect_refused([&] { return make_zonal_method(small); }, cloud(5, 0.9, 0), "exchange factors",
                   "sweeps");
}

}  // namespace
}  // namespace gischt
