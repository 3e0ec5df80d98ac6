// SPDX-License-Identifier: Apache-2.0
// The method as a whole: its bits, and the sign of its pixels.
#include "render/path/path.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/parallel.h"
#include "render/path/test_views.h"

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

TEST(Path, IsTheSameOnAnyNumberOfThreads) {
    const View view = crowded(24);
    Job job;
    const RenderResult all = make_path_method({})->render(view, settings_of(4, 20), job);
    const ThreadLimit one(1);
    const RenderResult single = make_path_method({})->render(view, settings_of(4, 20), job);
    EXPECT_EQ(all.image, single.image);
    EXPECT_EQ(all.statistics.rays, single.statistics.rays);
    EXPECT_EQ(all.statistics.lookups, single.statistics.lookups);
}

TEST(Path, FourPartsAreTheWhole) {
    const View view = crowded(12);
    Job job;
    FilmState whole, sum;
    RenderSettings settings = settings_of(64, 20);
    settings.film = &whole;
    make_path_method({})->render(view, settings, job);
    settings.samples_per_pixel = 16;
    for (const int first : {16, 0, 48, 32}) {
        FilmState part;
        settings.film = &part;
        settings.first_sample = first;
        make_path_method({})->render(view, settings, job);
        if (sum.film) {
            sum.merge(part);
        } else {
            sum = part;
        }
    }
    EXPECT_EQ(to_text(sum.ranges), to_text(whole.ranges));
    EXPECT_EQ(sum.image(), whole.image());
}

// The state that a checkpoint wrote is all that is left of a render that was killed.
TEST(Path, GoesOnFromACheckpointToTheSameBits) {
    const View view = crowded(16);
    Job job;
    RenderSettings settings = settings_of(24, 20);
    FilmState whole, film, kept;
    settings.film = &whole;
    make_path_method({})->render(view, settings, job);

    settings.film = &film;
    settings.checkpoint_interval = 0;
    int checkpoints = 0;
    // The third one, or the last of fewer, in the midst of the samples.
    settings.on_checkpoint = [&] {
        if (checkpoints < 3) kept = film;
        ++checkpoints;
    };
    make_path_method({})->render(view, settings, job);
    ASSERT_GE(checkpoints, 1);
    ASSERT_TRUE(kept.film);
    EXPECT_NE(kept.image(), whole.image());
    settings.on_checkpoint = {};
    settings.film = &kept;
    const ThreadLimit one(1);
    make_path_method({})->render(view, settings, job);
    EXPECT_EQ(to_text(kept.ranges), to_text(whole.ranges));
    EXPECT_EQ(kept.image(), whole.image());
}

// Transmittances from a grid are made exact at random, by adding what may be negative.
TEST(Path, NoPixelIsNegative) {
    const auto smoke = [](const Vec3d& p) {
        const double wisps = double(fractal_noise(4 * p, 5, 0.6f, 3));
        return length(p) > 0.9 ? 0 : std::max(0.0, wisps);
    };
    for (const double thickness : {10.0, 100.0, 1000.0}) {
        View view;
        view.camera = ortho({0, -3, 1}, 2, 40);
        view.background = Vec3f{};
        view.lights = {delta_sun({1, 0.5, 1}, Vec3f(3))};
        view.media = {voxels(64, smoke, coefficients(Vec3d(thickness), Vec3d(0.9), 0.5))};
        for (const int depth : {1, 33}) {
            Job job;
            const Image image =
                make_path_method({})->render(view, settings_of(16, depth), job).image;
            int count = 0;
            float least = 0;
            double mean = 0;
            for (const float v : image.channel("G")) {
                count += v < 0;
                least = std::min(least, v);
                mean += double(v) / 1600;
            }
            EXPECT_EQ(count, 0) << "of 1600, at least " << least << ", mean " << mean
                                << ", extinction " << thickness << ", depth " << depth;
        }
    }
}

}  // namespace
}  // namespace gischt
