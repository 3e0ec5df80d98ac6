// SPDX-License-Identifier: Apache-2.0
#include "fluid/cloud.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"

namespace gischt {
namespace {

CloudParams small_cloud() {
    CloudParams p;
    p.resolution = 40;
    return p;
}

const TileField<float>& density_of(const Frame& frame) {
    return frame.find("density")->component[0];
}

// Sum of the density over the domain.
double total(const TileField<float>& density) {
    double sum = 0;
    for (const float v : density.values()) sum += static_cast<double>(v);
    return sum;
}

TEST(Cloud, FillsAFairPartOfItsBoxWithDensitiesUpToOne) {
    Job job;
    const Frame frame = make_cloud(small_cloud(), {0, 0, 1}, 0, job);
    const TileField<float>& density = density_of(frame);
    const double cells = static_cast<double>(volume(density.map().bounds().size()));
    for (const float v : density.values()) {
        ASSERT_GE(v, 0);
        ASSERT_LE(v, 1);
    }
    EXPECT_GT(total(density) / cells, 0.08);
    EXPECT_LT(total(density) / cells, 0.6);
}

TEST(Cloud, IsTheSameOnAnyNumberOfThreadsAndAnotherWithAnotherSeed) {
    auto make = [](int threads, int seed) {
        const ThreadLimit limit(threads);
        Job job;
        CloudParams p = small_cloud();
        p.seed = seed;
        return make_cloud(p, {0, 0, 1}, 0, job);
    };
    const Frame one = make(1, 1), two = make(2, 1), other = make(2, 2);
    EXPECT_EQ(density_of(one).values(), density_of(two).values());
    EXPECT_NE(total(density_of(one)), total(density_of(other)));
}

// The base is where the cloud stands, whichever axis is up.
TEST(Cloud, HasItsFlatBaseBelowWhicheverAxisIsUp) {
    for (int up = 0; up < 3; ++up) {
        Job job;
        CloudParams p = small_cloud();
        Vec3d high(640, 640, 640), axis;
        p.min = {0, 0, 0};
        p.max = high;
        axis[up] = 1;
        const Frame frame = make_cloud(p, axis, 0, job);
        const TileField<float>& density = density_of(frame);
        const Vec3i n = density.map().bounds().size();
        double below = 0, above = 0;
        for (int t = 0; t < density.map().size(); ++t) {
            const Vec3i first = density.map().first_cell(t);
            for (int i = 0; i < tile_values; ++i) {
                const Vec3i c = first + density.map().shape().cell(i);
                (c[up] < n[up] / 2 ? below : above) += static_cast<double>(density.tile(t)[i]);
            }
        }
        EXPECT_GT(below, above) << "axis " << up;
        EXPECT_GT(above, 0) << "axis " << up;
    }
}

TEST(Cloud, RefusesAnEmptyBoxAndStopsWhenAsked) {
    CloudParams p = small_cloud();
    p.max.x = p.min.x;
    Job job;
    EXPECT_THROW(make_cloud(p, {0, 0, 1}, 0, job), Error);
    job.cancel();
    EXPECT_THROW(make_cloud(small_cloud(), {0, 0, 1}, 0, job), Error);
}

}  // namespace
}  // namespace gischt
