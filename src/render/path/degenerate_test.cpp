// SPDX-License-Identifier: Apache-2.0
// What the method makes of input that no one should give it: a picture that is right, or an error
// that names the fault.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <limits>

#include "optics/surface_rig.h"
#include "render/path/path.h"
#include "render/path/test_views.h"
#include "shape/mesh.h"

namespace gischt {
namespace {

using namespace path_test;

RenderSettings settings_of(int samples, int depth) {
    RenderSettings s;
    s.samples_per_pixel = samples;
    s.depth = depth;
    return s;
}

// Everything at once: media that overlap, a solid, lights of all kinds.
View crowded(int size) {
    View view;
    view.camera = ortho({2, -3, 1}, 2.5, size);
    view.media = {voxels(
                      16, [](const Vec3d& p) { return lumps(p); },
                      coefficients({2, 4, 8}, {0.95, 0.9, 0.8}, 0.7)),
                  voxels(
                      16, [](const Vec3d& p) { return lumps(p + Vec3d(0.6, 0, 0.4), 5); },
                      coefficients(Vec3d(3), Vec3d(1), -0.4))};
    view.lights = {delta_sun({1, -1, 1}, {3, 2, 1}), sky({0.1f, 0.2f, 0.3f}),
                   std::make_shared<PointLight>(Vec3d(0, -2, 0), Vec3f(2))};
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(0.7, 0, -0.6));
    ball.radius = Keyed<double>(0.3);
    view.surfaces = SurfaceSet({ball}, 0);
    return view;
}

// Finite and not negative, with not one sample that had to be thrown away.
void expect_sane(const View& view, const std::string& name, const PathParams& params = {}) {
    for (const int depth : {0, 1, 50}) {
        Job job;
        FilmState film;
        RenderSettings settings = settings_of(4, depth);
        settings.film = &film;
        const Image image = make_path_method(params)->render(view, settings, job).image;
        EXPECT_EQ(film.film->rejected(), 0) << name;
        for (const char* channel : {"R", "G", "B", "A"}) {
            for (const float v : image.channel(channel)) {
                ASSERT_TRUE(std::isfinite(v) && v >= 0) << name << " " << channel << " " << v;
            }
        }
    }
}
void expect_all_sane(const View& view, const std::string& name) {
    expect_sane(view, name);
    PathParams plain;
    plain.camera = CameraSegment::Tracking;
    plain.shadow = TransmittanceEstimator::Ratio;
    expect_sane(view, name + " (plain)", plain);
    plain.shadow = TransmittanceEstimator::Exact;
    expect_sane(view, name + " (exact)", plain);
}

TEST(PathDegenerate, SurvivesVoxelsThatAreNoNumbers) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const double bad[] = {
        std::numeric_limits<double>::quiet_NaN(), never, -never, -1e30, 1e-42, 1e29};
    View view = crowded(8);
    int i = 0;
    for (const double value : bad) {
        i = 0;
        const auto holes = [&](const Vec3d& p) { return ++i % 37 == 0 ? value : lumps(p); };
        view.media[0] = voxels(16, holes, coefficients({2, 4, 8}, Vec3d(0.9), 0.7));
        expect_all_sane(view, fmt::format("{}", value));
    }
    // Extinctions that float cannot reckon with are refused.
    const auto too_dense = [](const Vec3d&) { return 1e30; };
    EXPECT_THROW(voxels(16, too_dense, coefficients(Vec3d(8), Vec3d(0.9))), Error);
}

TEST(PathDegenerate, SurvivesLightsAndCamerasInsideOfMedia) {
    View view = crowded(8);
    const MediumPtr dense = voxels(
        16, [](const Vec3d& p) { return 500 * lumps(p); }, coefficients({2, 4, 8}, Vec3d(1), 0.9));
    view.media = {dense, view.media[1]};
    view.lights.push_back(std::make_shared<PointLight>(Vec3d(0.1, 0, 0), Vec3f(2)));
    expect_all_sane(view, "light inside");
    CameraParams inside;
    inside.position = Keyed<Vec3d>(Vec3d(0.1, 0, 0));
    inside.target = Keyed<Vec3d>(Vec3d(1, 0.2, 0));
    view.camera = Camera(inside, 0, 8, 8);
    expect_all_sane(view, "camera at the light, inside");
    // Along the faces of voxels and bricks.
    view.camera = ortho({-3, 0, 0}, 2, 8);
    expect_all_sane(view, "along an axis");
}

TEST(PathDegenerate, SurvivesNothing) {
    View view = crowded(8);
    view.media = {voxels(
                      16, [](const Vec3d&) { return 0.0; }, coefficients(Vec3d(1), Vec3d(1))),
                  voxels(
                      16, [](const Vec3d& p) { return lumps(p); }, coefficients({}, {}))};
    expect_all_sane(view, "clear media");
    view.media.clear();
    expect_all_sane(view, "no media");
    view.lights.clear();
    view.surfaces = {};
    expect_all_sane(view, "nothing");
    const Image black =
        make_path_method({})->render(view, settings_of(1, 5), *std::make_unique<Job>()).image;
    for (const float v : black.channel("R")) EXPECT_EQ(v, 0);
}

TEST(PathDegenerate, SurvivesASunBelowTheGround) {
    View view = crowded(8);
    GroundSurface ground;
    ground.point = Keyed<Vec3d>(Vec3d(0, 0, -0.5));
    view.surfaces = SurfaceSet({ground}, 0);
    view.lights = {delta_sun({0.3, 0.2, -1}, Vec3f(5)),
                   std::make_shared<SunLight>(Vec3d(0, 0, -1), Vec3f(5), 0.2)};
    expect_all_sane(view, "sun below");
    // What lies above the ground is dark.
    Job job;
    view.camera = ortho({0, -3, 3}, 0.5, 4);
    const Image image = make_path_method({})->render(view, settings_of(4, 5), job).image;
    for (const float v : image.channel("G")) EXPECT_EQ(v, 0);
}

// In the light of 1 from everywhere, where nothing absorbs or all that does shines with 1, all
// is 1.
void expect_all_one(const View& view, const std::string& name, double rounding = 2e-5) {
    const Estimate got =
        mean_radiance(view, {}, {.depth = 100'000'000, .batches = 32, .samples = 32});
    for (int c = 0; c < 3; ++c) expect_mean(got, c, 1, 3, name, rounding);
    expect_all_sane(view, name);
}

MediumPtr white_cloud(double extinction) {
    return voxels(
        16, [](const Vec3d& p) { return lumps(p); },
        coefficients(Vec3d(extinction), Vec3d(1), 0.7));
}

View furnace() {
    View view;
    view.camera = ortho({-2, 3, 1}, 2.2, 4);
    view.lights = {sky(Vec3f(1))};
    view.media = {white_cloud(4)};
    return view;
}

Material white_lambert() {
    Material m;
    m.albedo = m.checker = Vec3d(1);
    return m;
}

// Two that are the same place by place, with other materials and other insides.
TEST(PathDegenerate, SurfacesThatCoincideLoseNoLight) {
    SphereSurface ball;
    ball.radius = 0.8;
    RectSurface sheet;
    sheet.two_sided = true;
    sheet.size = {1.5, 1.5};
    Material lambert = white_lambert(), mirror, glass, fog;
    mirror.kind = MaterialKind::Conductor;
    mirror.color = Vec3d(1);
    glass.kind = MaterialKind::Dielectric;
    glass.medium = coefficients(Vec3d(2), Vec3d(1), 0.5);
    fog.kind = MaterialKind::None;
    fog.medium = coefficients({1, 2, 4}, Vec3d(1), -0.5);
    Material dense_glass = glass;
    dense_glass.ior = 1.8;
    dense_glass.medium = coefficients(Vec3d(20), Vec3d(1));

    View view = furnace();
    const auto set = [&](auto solid, const Material& first, const Material& second) {
        std::vector<SurfaceParams> both;
        solid.material = first;
        both.push_back(solid);
        solid.material = second;
        both.push_back(solid);
        view.surfaces = SurfaceSet(both, 0);
    };
    set(sheet, lambert, mirror);
    expect_all_one(view, "sheets");
    set(ball, lambert, mirror);
    expect_all_one(view, "balls");
    const Material* insides[] = {&glass, &dense_glass, &fog};
    for (const Material* first : insides) {
        for (const Material* second : insides) {
            set(ball, *first, *second);
            expect_all_one(view, fmt::format("insides {} {}", first->ior, second->ior));
        }
        set(ball, *first, lambert);
        expect_all_one(view, "an inside and a ball");
    }
}

// Triangles without an area and points that are no numbers are left out, and told of.
TEST(PathDegenerate, FaultyTrianglesChangeNothing) {
    MeshSurface params;
    params.file = "ball";
    params.material = white_lambert();
    const auto good = [](const std::string&, Job&) { return ball_mesh(0.7, 2); };
    const auto bad = [](const std::string&, Job&) {
        Mesh mesh = ball_mesh(0.7, 2);
        const int n = static_cast<int>(mesh.points.size());
        const float nan = std::numeric_limits<float>::quiet_NaN();
        mesh.points.insert(mesh.points.end(), {{nan, 0, 0}, {0, INFINITY, 0}, {9, 9, 9}});
        if (!mesh.normals.empty()) mesh.normals.resize(mesh.points.size(), {0, 0, 1});
        for (const Vec3i& t : {Vec3i(n, 0, 1), Vec3i(0, n + 1, 1), Vec3i(3, 3, 4), Vec3i(5, 5, 5),
                               Vec3i(0, 1, n + 7), Vec3i(-1, 2, 3)}) {
            mesh.triangles.push_back(t);
        }
        return mesh;
    };
    Job job;
    std::string told;
    job.on_message = [&](Job::Level, std::string_view text) { told += text; };
    View view = furnace();
    view.surfaces = SurfaceRig({params}, {}, {0, 0, 1}, good, {}, job).at(0, 0, {});
    EXPECT_EQ(told, "");
    const Image clean = make_path_method({})->render(view, settings_of(4, 20), job).image;
    view.surfaces = SurfaceRig({params}, {}, {0, 0, 1}, bad, {}, job).at(0, 0, {});
    EXPECT_NE(
        told.find("6 triangles dropped: 2 without area, 2 with points that are not finite, 2"),
        told.npos)
        << told;
    const Image repaired = make_path_method({})->render(view, settings_of(4, 20), job).image;
    EXPECT_EQ(clean, repaired);
    expect_all_one(view, "mesh");
}

// A lamp as bright as the sky, in a medium that its light leaves after many scatterings only.
TEST(PathDegenerate, ALampInsideADenseMediumShinesAsItShould) {
    SphereSurface lamp;
    lamp.radius = 0.1;
    lamp.material.albedo = lamp.material.checker = {};
    lamp.material.emission = Keyed<Vec3d>(Vec3d(1));
    View view = furnace();
    view.media = {white_cloud(200)};
    view.surfaces = SurfaceSet({lamp}, 0);
    expect_all_one(view, "lamp");
}

TEST(PathDegenerate, CamerasInsideSeeWhatIsThere) {
    CameraParams camera;
    camera.position = Keyed<Vec3d>(Vec3d(0.1, 0.05, 0));
    camera.target = Keyed<Vec3d>(Vec3d(1, 0.2, 0.3));
    View view = furnace();
    view.camera = Camera(camera, 0, 4, 4);
    for (const double extinction : {1.0, 100.0}) {
        view.media = {white_cloud(extinction)};
        expect_all_one(view, "in a cloud");
    }
    // The radiance in glass counts as L / n^2.
    SphereSurface glass;
    glass.radius = 0.9;
    glass.material.kind = MaterialKind::Dielectric;
    for (const double extinction : {0.0, 3.0, 20.0}) {
        glass.material.medium = coefficients(Vec3d(extinction), Vec3d(1), 0.8);
        view.surfaces = SurfaceSet({glass}, 0);
        expect_all_one(view, fmt::format("in glass filled with {} 1/m", extinction));
    }
    // At the very boundary, and at the middle.
    for (const Vec3d& at : {Vec3d(0.9, 0, 0), Vec3d(0, 0, 0)}) {
        camera.position = Keyed<Vec3d>(at);
        view.camera = Camera(camera, 0, 4, 4);
        expect_all_one(view, "on the boundary");
    }
}

// The message names light, solid, and what can be done.
TEST(PathDegenerate, LightsWithoutSizeBehindGlassAreRefused) {
    SphereSurface glass;
    glass.name = "bulb";
    glass.material.kind = MaterialKind::Dielectric;
    glass.material.medium = coefficients(Vec3d(1), Vec3d(1));
    View view = furnace();
    view.surfaces = SurfaceSet({glass}, 0);
    auto sun = std::make_shared<SunLight>(Vec3d(0, 0, 1), Vec3f(1), 0.01);
    auto point = std::make_shared<PointLight>(Vec3d(2, 0, 0), Vec3f(1));
    sun->name = "noon";
    point->name = "candle";
    for (const LightPtr& light : std::vector<LightPtr>{sun, point}) {
        view.lights = {sky(Vec3f(1)), light};
        Job job;
        try {
            make_path_method({})->render(view, settings_of(1, 4), job);
            FAIL() << light->name;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Usage);
            const std::string text = e.what();
            for (const char* word : {light->name.c_str(), "bulb", "sphere", "march"}) {
                EXPECT_NE(text.find(word), text.npos) << text;
            }
        }
    }
    // Without a medium there is nothing that they would have to reach.
    glass.material.medium.reset();
    view.surfaces = SurfaceSet({glass}, 0);
    expect_all_sane(view, "hollow glass");
}

}  // namespace
}  // namespace gischt
