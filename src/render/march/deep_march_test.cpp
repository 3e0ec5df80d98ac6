// SPDX-License-Identifier: Apache-2.0
#include "render/march/deep_march.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/march/march.h"
#include "render/march/ray_march.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

// The mean of the picture of a view, by marching.
Estimate marched(const View& view, int depth, const MarchParams& params, int batches) {
    Job job;
    const MarchScene scene(view, params, job, depth);
    RayMarcher marcher(scene);
    const Seen seen = [&](const Ray& ray, const PixelSampler& numbers) {
        const MarchedRay r = marcher(ray, numbers);
        return Vec3d(r.radiance + r.transmittance * background(view, ray.direction).radiance);
    };
    return mean_of_part(view, seen, 0, 0, 1, {.batches = batches, .samples = 64, .seed = 3});
}

// Marching has an error of its steps beside its noise; these are short enough for `bias`.
void expect_path(const View& view, int depth, double bias, const std::string& name,
                 int batches = 48) {
    MarchParams params;
    params.step = params.shadow_step = 0.5;
    params.step_depth = 0.1;
    const Estimate march = marched(view, depth, params, batches);
    const Estimate path =
        mean_radiance(view, {}, {.depth = depth, .batches = batches, .samples = 256, .seed = 5});
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(march.error[c], path.error[c]);
        EXPECT_LT(error, 0.01 * path.mean[c]) << name;
        EXPECT_NEAR(march.mean[c], path.mean[c],
                    critical_z(24, batches) * error + bias * path.mean[c])
            << name << " depth " << depth << " channel " << c << " error " << error;
    }
}

View lit(MediumPtr medium) {
    View view;
    view.camera = ortho({0, -4, 0}, 2.2, 16);
    view.media = {std::move(medium)};
    view.lights = {delta_sun({-1, -0.5, 1}, Vec3f(3)), sky({0.2f, 0.25f, 0.4f})};
    return view;
}

TEST(DeepMarch, EveryDepthIsThatOfThePathTracer) {
    const View view = lit(voxels(
        24, [](const Vec3d& p) { return lumps(p); }, coefficients(Vec3d(5), Vec3d(0.95), 0.5)));
    for (const int depth : {2, 3, 5}) expect_path(view, depth, 0.004, "lumps");
}

TEST(DeepMarch, ColourSurfacesAndDrawnSkies) {
    View view = lit(
        solid(Region::sphere({0, 0, 0.2}, 0.8), coefficients({1, 2, 4}, {0.9, 0.8, 0.7}, -0.3)));
    // A sky with a bright quarter.
    const auto map = std::make_shared<const EnvironmentMap>(
        64, 32, [](const Vec3d& d) { return Vec3f(d.x > 0 && d.z > 0 ? 2.0f : 0.1f); });
    view.lights[1] = std::make_shared<EnvironmentLight>(map, Transform{}, Vec3f(1));
    BoxSurface floor;
    floor.center = Keyed<Vec3d>(Vec3d(0, 0, -0.9));
    floor.size = Vec3d(6, 6, 0.2);
    floor.material.albedo = Vec3d(0.8, 0.5, 0.3);
    view.surfaces = SurfaceSet({floor}, 0);
    for (const int depth : {2, 4}) expect_path(view, depth, 0.006, "floor", 96);
}

TEST(DeepMarch, GlowLightsItsSmoke) {
    MediumParams p = coefficients(Vec3d(3), Vec3d(0.8));
    p.emission = EmissionKind::Blackbody;
    View view = lit(solid(Region::sphere({}, 0.9), p, 3000));
    view.lights.clear();
    expect_path(view, 2, 0.004, "glow");
}

// With a gather at every step the sums of eq. 20 are taken as they stand.
TEST(DeepMarch, AllStepsGatherTheSame) {
    const View view = lit(solid(Region::sphere({}, 0.9), coefficients(Vec3d(2), Vec3d(1))));
    MarchParams some, all;
    some.step = all.step = 4;
    all.gathers = 0;
    expect_same_mean(marched(view, 3, some, 64), marched(view, 3, all, 32), 3, "gathers");
}

// Whatever the share of the steps, a step counts once on average.
TEST(GatherPlaces, WeightsAverageToOne) {
    constexpr int n = 20'000;
    for (const double per_unit : {0.7, 4.0, 50.0}) {
        double sum[3] = {};
        for (int i = 0; i < n; ++i) {
            GatherPlaces places(per_unit, (static_cast<float>(i) + 0.5f) / n);
            const float share[3] = {0.01f, 0.3f, 0.2f};
            for (int k = 0; k < 3; ++k) sum[k] += static_cast<double>(places.weight_of(share[k]));
        }
        for (const double s : sum) EXPECT_NEAR(s / n, 1, 0.02) << per_unit;
    }
    GatherPlaces every(0, 0.3f);
    EXPECT_EQ(every.weight_of(0.2f), 1);
    EXPECT_EQ(every.weight_of(0), 0);
}

}  // namespace
}  // namespace gischt
