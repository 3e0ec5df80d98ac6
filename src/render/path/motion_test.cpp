// SPDX-License-Identifier: Apache-2.0
// Motion blur of media, and the motion layer, against what is known of even motion.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/units.h"
#include "math/quadrature.h"
#include "optics/moving_media.h"
#include "render/method.h"
#include "render/params.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

constexpr int voxels_across = 48;
constexpr double edge = 2.0 / voxels_across, width = 5 * edge;  // of a voxel, of the lump
constexpr double shutter = 0.5;                                 // s
const Vec3d speed{0, 0.9, 0.3};                                 // m/s: eleven voxels

double lump(const Vec3d& p) {
    const double r2 = dot(p, p) / (width * width);
    return r2 < 24 ? std::exp(-0.5 * r2) : 0;
}

// A lump of density in even motion, as a fluid's frame.
std::shared_ptr<const Frame> lump_frame() {
    auto frame = std::make_shared<Frame>();
    add_field(*frame, "density", voxels_across, lump);
    Field& velocity = frame->fields["velocity"];
    for (int a = 0; a < 3; ++a) {
        add_field(*frame, "axis", voxels_across, [a](const Vec3d&) { return speed[a]; });
        velocity.to_world = frame->fields["axis"].to_world;
        velocity.component.push_back(frame->fields["axis"].component[0]);
    }
    frame->fields.erase("axis");
    return frame;
}

View blurred_view(const MediumParams& params, int most_parts) {
    static const std::shared_ptr<const Frame> frame = lump_frame();
    Job job;
    View view;
    view.frames = {frame};
    view.media = {std::make_shared<const Medium>(*frame, params, 0, job)};
    view.camera = ortho({5, 0, 0}, 1.6);
    if (most_parts == 0) return view;
    view.shutter = shutter;
    for (const auto& m :
         media_while_exposed(*frame, view.media[0], params, {0, shutter, most_parts}, job)) {
        view.moving_media.push_back({m});
    }
    return view;
}

// Of one point of the picture, from a moment of the shutter for each sample.
Estimate look_at(const View& view, const PathParams& params, const Vec2d& place, int batches,
                 const std::function<Vec3d(const TracedRay&)>& value) {
    Job job;
    const PathScene scene(view, params, job);
    PathTracer tracer(scene, 20, false);
    constexpr int samples = 128;
    return estimate(batches, [&](int batch) {
        Vec3d sum;
        for (int i = 0; i < samples; ++i) {
            const PixelSampler numbers(random_key(11, static_cast<std::uint64_t>(batch)), 1, 0, 0,
                                       static_cast<std::uint32_t>(i));
            sum += value(tracer(view.camera.ray(place.x, place.y), numbers.one(2), numbers));
        }
        return sum / Vec3d(samples);
    });
}

// Transmittance of the lump on the line through (y, z) along x at a moment.
double truth_at(double extinction, double y, double z, double moment) {
    const Vec3d p = Vec3d(0, y, z) - (moment - 0.5) * shutter * speed;
    return std::exp(-extinction * width * std::sqrt(2 * pi) * lump(p));
}

// A point of the one pixel, 1.6 m wide, on the line through (y, z). Through centres of voxels the
// lattice knows the lump's integral without error.
Vec2d place_of(double y, double z) {
    return {0.5 + y / 1.6, 0.5 - z / 1.6};
}

TEST(MotionBlur, IsTheConvolutionOfTheTransmittanceWithTheShutter) {
    const View view = blurred_view(coefficients(Vec3d(6), {}), 27);
    ASSERT_EQ(view.moving_media.size(), 27u);
    EXPECT_EQ(view.moving_media[13][0], view.media[0]);
    static const GaussLegendre rule(32);
    for (const auto camera : {CameraSegment::Profile, CameraSegment::Tracking}) {
        PathParams params;
        params.camera = camera;
        for (const auto& [j, k] : {std::pair{0.5, 0.5}, {7.5, 2.5}, {-4.5, 3.5}, {9.5, -2.5}}) {
            const double y = j * edge, z = k * edge;
            const double truth =
                rule.integrate(0, 1, [&](double m) { return truth_at(6, y, z, m); });
            const Estimate got =
                look_at(view, params, place_of(y, z), 200,
                        [](const TracedRay& ray) { return Vec3d(1 - double(ray.alpha)); });
            // Carried along by cubic interpolation; the rest is the noise.
            expect_mean(got, 0, truth, 8, fmt::format("y {} z {}", y, z), 2e-3);
            // And it is not the sharp one.
            EXPECT_GT(std::abs(truth_at(6, y, z, 0.5) - truth), 0.015);
        }
    }
}

// Few moments: the mean over the media of these.
TEST(MotionBlur, OfFewMomentsIsTheirMean) {
    const View view = blurred_view(coefficients(Vec3d(6), {}), 8);
    ASSERT_EQ(view.moving_media.size(), 3u);
    for (const double y : {0.5 * edge, 6.5 * edge}) {
        double truth = 0;
        for (const double m : {1.0 / 6, 0.5, 5.0 / 6}) truth += truth_at(6, y, 0.5 * edge, m) / 3;
        const Estimate got =
            look_at(view, {}, place_of(y, 0.5 * edge), 200,
                    [](const TracedRay& ray) { return Vec3d(1 - double(ray.alpha)); });
        expect_mean(got, 0, truth, 2, fmt::format("y {}", y), 2e-3);
    }
}

// All ways to the same picture of scattered light.
TEST(MotionBlur, IsTheSameWithEveryEstimator) {
    View view = blurred_view(coefficients(Vec3d(6), Vec3d(0.9), 0.4), 9);
    view.lights = {delta_sun({0.2, 1, 0.5}, Vec3f(3))};
    std::vector<Estimate> all;
    using T = TransmittanceEstimator;
    for (const T shadow : {T::Exact, T::Ratio, T::ResidualRatio, T::Cached}) {
        PathParams params;
        params.shadow = shadow;
        params.cache_nodes = 100'000;  // coarse: what is wrong with it is to be corrected
        if (shadow == T::Ratio) params.camera = CameraSegment::Tracking;
        all.push_back(look_at(view, params, place_of(0.2, 0.05), 250,
                              [](const TracedRay& ray) { return Vec3d(ray.radiance); }));
        EXPECT_LT(all.back().error.x, 0.02 * all.back().mean.x);
        expect_same_mean(all.back(), all[0], 9, fmt::format("{}", static_cast<int>(shadow)));
    }
}

TEST(MotionBlur, WithoutAShutterHasTheBitsOfNone) {
    View still = blurred_view(coefficients(Vec3d(6), Vec3d(0.9)), 0);
    still.lights = {delta_sun({0.2, 1, 0.5}, Vec3f(3))};
    still.camera = ortho({5, 0, 0}, 1.6, 12);
    View blurred = still;
    Job job;
    const auto media = media_while_exposed(*still.frames[0], still.media[0],
                                           coefficients(Vec3d(6), Vec3d(0.9)), {0, 0, 9}, job);
    EXPECT_EQ(media, std::vector<MediumPtr>{still.media[0]});
    blurred.moving_media = {media};
    const auto method = make_method("path", RenderParams{});
    RenderSettings settings;
    settings.samples_per_pixel = 2;
    settings.depth = 3;
    const Image a = method->render(still, settings, job).image,
                b = method->render(blurred, settings, job).image;
    EXPECT_TRUE(std::ranges::equal(a.channel("R"), b.channel("R")));
}

TEST(MotionBlur, HasTheSameBitsFromOneThreadAndTwo) {
    View view = blurred_view(coefficients(Vec3d(6), Vec3d(0.9)), 9);
    view.lights = {delta_sun({0.2, 1, 0.5}, Vec3f(3))};
    view.camera = ortho({5, 0, 0}, 1.6, 40);
    RenderSettings settings;
    settings.samples_per_pixel = 4;
    settings.depth = 3;
    std::vector<std::vector<float>> red;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        Job job;
        const Image image = make_method("path", RenderParams{})->render(view, settings, job).image;
        const auto r = image.channel("R");
        red.emplace_back(r.begin(), r.end());
    }
    EXPECT_EQ(red[0], red[1]);
}

// Pixels per frame of a point of the picture, over the share that is hit.
Vec2d motion_at(const View& view, double x, double y, CameraSegment camera, float moment = 0.5f) {
    Job job;
    PathParams params;
    params.camera = camera;
    const PathScene scene(view, params, job);
    PathTracer tracer(scene, 2, false);
    tracer.show_motion();
    Vec2d sum;
    double share = 0;
    for (int i = 0; i < 256; ++i) {
        const PixelSampler numbers(3, 1, 0, 0, static_cast<std::uint32_t>(i));
        const TracedRay& seen = tracer(view.camera.ray(x, y, {}, double(moment)), moment, numbers);
        sum = {sum.x + double(seen.motion.x), sum.y + double(seen.motion.y)};
        share += double(seen.opacity);
    }
    EXPECT_GT(share, 0);
    return {sum.x / share, sum.y / share};
}

// From (5, 0, 0) towards the origin, 80 pixels of 2 cm; y is to the right, z up.
FrameCameras resting_cameras(const Camera& camera, double interval) {
    return {camera, camera, interval};
}

TEST(MotionLayer, OfASmokeThatMovesIsItsVelocityOnTheScreen) {
    View view = blurred_view(coefficients(Vec3d(6), Vec3d(0.5)), 9);
    view.camera = ortho({5, 0, 0}, 1.6, 80);
    view.around = resting_cameras(view.camera, 0.04);
    for (const auto camera : {CameraSegment::Profile, CameraSegment::Tracking}) {
        for (const float moment : {0.1f, 0.5f}) {
            const Vec2d motion = motion_at(view, 40, 40, camera, moment);
            EXPECT_NEAR(motion.x, 0.9 * 0.04 / 0.02, 2e-3);
            EXPECT_NEAR(motion.y, -0.3 * 0.04 / 0.02, 2e-3);
        }
    }
}

TEST(MotionLayer, OfASurfaceIsThatOfItsKeyframes) {
    SphereSurface ball;
    ball.center = Keyed<Vec3d>({0, 1}, {Vec3d(0, 0, -0.5), Vec3d(0, 1, 0)});
    ball.radius = 0.3;
    BoxSurface box;  // turns around x, half a turn per second
    box.center = Vec3d(0, -1, 0);
    box.size = Vec3d(0.8);
    box.rotation_degrees = Keyed<Vec3d>({0, 1}, {Vec3d(), Vec3d(180, 0, 0)});
    for (const double open : {0.0, 0.1}) {
        View view;
        view.time = 0.4;
        view.shutter = open;
        view.camera = ortho({5, 0, 0}, 4, 80);  // 5 cm
        view.around = resting_cameras(view.camera, 0.02);
        view.surfaces = SurfaceSet({ball, box}, view.time, {0, 0, 1}, open);
        for (const float moment : {0.5f, 0.8f}) {
            // y 0.4, z -0.3: 8 pixels to the right and 6 down.
            const Vec2d of_ball = motion_at(view, 48, 46, CameraSegment::Profile, moment);
            EXPECT_NEAR(of_ball.x, 1 * 0.02 / 0.05, 1e-5);
            EXPECT_NEAR(of_ball.y, -0.5 * 0.02 / 0.05, 1e-5);
            // A point 0.25 to the right of the axis moves up by pi times that per second.
            if (open > 0 && moment != 0.5f) continue;
            const Vec2d of_box = motion_at(view, 25, 40, CameraSegment::Profile, moment);
            EXPECT_NEAR(of_box.x, 0, 1e-4);
            EXPECT_NEAR(of_box.y, -pi * 0.25 * 0.02 / 0.05, 1e-3);
        }
    }
}

// Things at rest pass by a camera that moves, the nearer the faster.
TEST(MotionLayer, CountsTheCamera) {
    CameraParams params;
    params.position = Keyed<Vec3d>({0, 1}, {Vec3d(4, 0, 0), Vec3d(4, 1, 0)});
    params.target = Keyed<Vec3d>({0, 1}, {Vec3d(0, 0, 0), Vec3d(0, 1, 0)});
    params.fov_degrees = 2 * std::atan(0.5) * 180 / pi;
    View view;
    view.time = 0.5;
    view.camera = Camera(params, 0.5, 100, 100);
    view.around = {Camera(params, 0.45, 100, 100), Camera(params, 0.55, 100, 100), 0.1};
    BoxSurface box;
    box.center = Vec3d(0, 0.5, 0);
    box.size = Vec3d(2);
    view.surfaces = SurfaceSet({box}, 0.5);
    // The face lies 3 m away, where a pixel is 3 cm wide.
    const Vec2d motion = motion_at(view, 50.3, 50.3, CameraSegment::Profile);
    EXPECT_NEAR(motion.x, -0.1 / 0.03, 1e-4);
    EXPECT_NEAR(motion.y, 0, 1e-4);
}

}  // namespace
}  // namespace gischt
