// SPDX-License-Identifier: Apache-2.0
// All estimators of the path tracer have the same mean.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/units.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

struct NamedParams {
    std::string name;
    PathParams params;
};

// The plain path tracer, which everything is compared with.
PathParams plain() {
    PathParams p;
    p.shadow = TransmittanceEstimator::Ratio;
    p.camera = CameraSegment::Tracking;
    p.bridge = false;
    p.roulette = 0;
    return p;
}

std::vector<NamedParams> alternatives() {
    std::vector<NamedParams> all;
    const auto add = [&](const std::string& name, const PathParams& base, const auto& change) {
        all.push_back({name, base});
        change(all.back().params);
    };
    using Shadow = TransmittanceEstimator;
    add("roulette", plain(), [](PathParams& p) { p.roulette = 0.5; });
    add("residual ratio", plain(), [](PathParams& p) { p.shadow = Shadow::ResidualRatio; });
    add("exact", plain(), [](PathParams& p) { p.shadow = Shadow::Exact; });
    add("cached", plain(), [](PathParams& p) { p.shadow = Shadow::Cached; });
    add("march", plain(), [](PathParams& p) { p.shadow = Shadow::March; });
    add("bridge", plain(), [](PathParams& p) { p.bridge = true; });
    add("profile of 1", {}, [](PathParams& p) {
        p = plain();
        p.camera = CameraSegment::Profile;
        p.points = 1;
    });
    add("as it is", {}, [](PathParams&) {});
    add("no bridge", {}, [](PathParams& p) { p.bridge = false; });
    add("8 points, 3 splits, exact", {}, [](PathParams& p) {
        p.points = 8;
        p.splits = 3;
        p.shadow = Shadow::Exact;
    });
    add("3 paths from surfaces", {}, [](PathParams& p) { p.surface_splits = 3; });
    add("3 points, 8 splits, residual", {}, [](PathParams& p) {
        p.points = 3;
        p.splits = 8;
        p.shadow = Shadow::ResidualRatio;
    });
    add("coarse cache", {}, [](PathParams& p) {
        p.cache_nodes = 100;
        p.correction = 0.5;
    });
    return all;
}

struct Scene {
    std::string name;
    View view;
};

// Two clouds that overlap, scattering forward and backward, seen from the side.
View clouds(bool is_grey) {
    MediumParams a = coefficients(is_grey ? Vec3d(4) : Vec3d(1, 4, 15), {0.95, 0.9, 0.8}, 0.7);
    MediumParams b = coefficients(is_grey ? Vec3d(3) : Vec3d(5, 2, 0), Vec3d(0.9), -0.4);
    View view;
    view.camera = ortho({2, -3, 1}, 2);
    view.media = {voxels(
                      16, [](const Vec3d& p) { return lumps(p); }, a),
                  voxels(
                      16, [](const Vec3d& p) { return lumps(p + Vec3d(0.6, 0, 0.4), 5); }, b)};
    view.background = Vec3f{};
    return view;
}

// A lamp of 0.6 m at the side, that shines into the clouds.
RectSurface lamp() {
    RectSurface rect;
    rect.center = Keyed<Vec3d>(Vec3d(1.2, -0.5, 0.8));
    rect.target = Keyed<Vec3d>(Vec3d{});
    rect.size = {0.6f, 0.6f};
    rect.two_sided = true;
    rect.material.emission = Keyed<Vec3d>(Vec3d(6, 5, 4));
    return rect;
}

// The first cloud glows, by its temperature or its flame.
MediumPtr fire(EmissionKind kind) {
    Frame frame;
    add_field(frame, "density", 16, [](const Vec3d& p) { return lumps(p); });
    add_field(frame, "temperature", 16,
              [](const Vec3d& p) { return 900 + 900 * std::max(0.0, 1 - 2 * length(p)); });
    // It burns next to the smoke too.
    add_field(frame, "flame", 16,
              [](const Vec3d& p) { return std::max(0.0, 1 - 2 * length(p - Vec3d(0.4, 0, 0.4))); });
    MediumParams p = coefficients({2, 4, 8}, {0.7, 0.6, 0.5}, 0.5);
    p.emission = kind;
    Job job;
    return std::make_shared<const Medium>(frame, p, 0, job);
}

std::vector<Scene> scenes(bool is_grey) {
    const View base = clouds(is_grey);
    std::vector<Scene> all;
    const auto lit = [&](const std::string& name, std::vector<LightPtr> lights) -> View& {
        all.push_back({name, base});
        all.back().view.lights = std::move(lights);
        return all.back().view;
    };
    const Vec3d towards = normalize(Vec3d(-1, 1, 1));
    lit("delta sun", {delta_sun(towards, {3, 2, 1})});
    lit("sun disc", {std::make_shared<SunLight>(towards, Vec3f(3, 2, 1), 0.3)});
    lit("two suns",
        {delta_sun(towards, {3, 2, 1}), std::make_shared<SunLight>(Vec3d(0, 0, 1), Vec3f(1), 0.1)});
    lit("even sky", {sky({0.5f, 0.7f, 1})});
    lit("bright and dark sky",
        {std::make_shared<EnvironmentLight>(
             std::make_shared<EnvironmentMap>(
                 32, 16,
                 [](const Vec3d& d) { return Vec3f(static_cast<float>(std::exp(2 * d.x + d.z))); }),
             Transform{}, Vec3f(1)),
         sky({0.1f, 0.2f, 0.3f})});
    lit("points", {std::make_shared<PointLight>(Vec3d(1.3, 0.2, 0.9), Vec3f(3)),
                   std::make_shared<PointLight>(Vec3d(-1, -1, 0.3), Vec3f(1, 2, 3))});
    lit("lamp", {}).surfaces = SurfaceSet({lamp()}, 0);
    View& ground = lit("ground and sun", {delta_sun({-1, -1, 1}, {3, 2, 1}), sky(Vec3f(0.2f))});
    GroundSurface floor;
    floor.point = Keyed<Vec3d>(Vec3d(0, 0, -0.7));
    floor.material.albedo = {0.8, 0.6, 0.4};
    ground.surfaces = SurfaceSet({floor}, 0);
    // What the camera does not see casts light and shadow all the same.
    View& hidden = lit("a lamp that the camera does not see", {});
    RectSurface rect = lamp();
    rect.center = Keyed<Vec3d>(Vec3d(0.8, -1.2, 0.4));
    rect.material.camera_visible = false;
    hidden.surfaces = SurfaceSet({rect}, 0);
    if (is_grey) return all;
    lit("blackbody", {}).media[0] = fire(EmissionKind::Blackbody);
    lit("flame", {}).media[0] = fire(EmissionKind::Flame);
    // A wall through the fire, that hides half of it from every point.
    View& wall = lit("flame and wall", {});
    wall.media[0] = fire(EmissionKind::Flame);
    BoxSurface box;
    box.center = Keyed<Vec3d>(Vec3d(0.4, 0.1, 0.2));
    box.size = {0.05, 1.5, 1};
    wall.surfaces = SurfaceSet({box}, 0);
    return all;
}

void expect_agreement(int samples, std::uint64_t seed) {
    const auto rows = alternatives();
    for (const bool is_grey : {true, false}) {
        const auto all = scenes(is_grey);
        const int comparisons = 2 * 3 * static_cast<int>(rows.size() * all.size());
        for (const Scene& scene : all) {
            Effort effort{.depth = 6, .batches = 64, .samples = 4 * samples, .seed = seed};
            const Estimate expected = mean_radiance(scene.view, plain(), effort);
            EXPECT_GT(max_component(expected.mean), 0) << scene.name;
            effort.samples = samples;
            for (const NamedParams& row : rows) {
                ++effort.seed;
                expect_same_mean(
                    mean_radiance(scene.view, row.params, effort), expected, comparisons,
                    fmt::format("{} {}, {}", is_grey ? "grey" : "colored", scene.name, row.name));
            }
        }
    }
}

TEST(PathAgreement, OfAllEstimatorsUnderAllLights) {
    expect_agreement(64, 1);
}
TEST(PathAgreementLong, OfAllEstimatorsUnderAllLights) {
    expect_agreement(1024, 100);
}

}  // namespace
}  // namespace gischt
