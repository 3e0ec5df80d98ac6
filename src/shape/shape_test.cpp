// SPDX-License-Identifier: Apache-2.0
#include "shape/shape.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace gischt {
namespace {

const Shape solids[] = {
    Sphere{{0.2, -0.1, 0.4}, 0.7},
    SolidBox{{0.1, 0.2, 0.3}, {1, 0.6, 0.8}, Transform::rotation(normalize(Vec3d(1, 2, 3)), 0.6)},
    Plane{{0, 0, -0.3}, normalize(Vec3d(0.2, 0.1, 1))},
    Rectangle{{0.1, 0.2, 0.3}, {1.2, 0.4, 0}, {-0.3, 0.9, 0}},
    Disc{{-0.2, 0.3, 0.1}, normalize(Vec3d(0.2, -0.7, 1)), 0.8}};

// A hit lies on the surface, its normal is the gradient of the distance, and nothing lies before
// it.
TEST(Shape, HitsAgreeWithTheSignedDistance) {
    for (const Shape& s : solids) {
        int hits = 0;
        for (std::uint32_t n = 0; n < 2000; ++n) {
            const std::uint64_t key = random_key(4, n);
            auto u = [&](std::uint32_t d) { return 4.0 * random_uniform(key, d) - 2.0; };
            Ray ray{{u(0), u(1), u(2)}, {u(3), u(4), u(5)}};
            ray.t_max = 10;
            const auto hit = intersect(s, ray);
            const double start = signed_distance(s, ray.origin);
            const double end = hit ? hit->t : ray.t_max;
            for (double f = 0; f < 0.999; f += 0.05) {
                const double d = signed_distance(s, ray.at(f * end));
                ASSERT_GE(d * start, -1e-9) << "the surface was crossed before the hit";
            }
            if (!hit) continue;
            ++hits;
            const Vec3d p = ray.at(hit->t);
            EXPECT_NEAR(signed_distance(s, p), 0, 1e-9);
            EXPECT_NEAR(length(hit->normal), 1, 1e-12);
            EXPECT_NEAR(signed_distance(s, p + 1e-4 * hit->normal), 1e-4, 1e-7);
        }
        EXPECT_GT(hits, 40);
    }
}

TEST(Shape, BoundsHoldTheSolid) {
    for (const Shape& s : {solids[0], solids[1]}) {
        const Box3d b = bounds(s);
        for (std::uint32_t n = 0; n < 2000; ++n) {
            const std::uint64_t key = random_key(8, n);
            const Vec3d p(4.0 * random_uniform(key, 0) - 2, 4.0 * random_uniform(key, 1) - 2,
                          4.0 * random_uniform(key, 2) - 2);
            if (signed_distance(s, p) < 0) {
                EXPECT_TRUE(b.contains(p));
            }
        }
    }
}

}  // namespace
}  // namespace gischt
