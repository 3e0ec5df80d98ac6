// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "math/keyframes.h"
#include "math/noise.h"
#include "math/quadrature.h"
#include "math/ray.h"
#include "math/sobol.h"
#include "math/statistics.h"
#include "math/transform.h"

namespace gischt {
namespace {

TEST(Transform, InverseUndoesAnyAffineMap) {
    Transform m = Transform::rotation(normalize(Vec3d(1, 2, -1)), 0.7) *
                  Transform::scale_translate(0.3, {1, -2, 5});
    const Vec3d p(0.1, 4, -7), q = m.inverse().point(m.point(p));
    EXPECT_LT(length(q - p), 1e-12);
    EXPECT_NEAR(m.determinant(), 0.027, 1e-12);
}

TEST(OrthonormalFrame, IsRightHandedForEveryDirection) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const float z = 2 * random_uniform(random_key(3, i), 0) - 1,
                    phi = 6.2831853f * random_uniform(random_key(3, i), 1);
        const float r = std::sqrt(1 - z * z);
        const Vec3f n(r * std::cos(phi), r * std::sin(phi), i == 0 ? -1.0f : z);
        if (i == 0) continue;
        Vec3f s, t;
        orthonormal_frame(n, s, t);
        EXPECT_NEAR(dot(s, t), 0, 1e-5);
        EXPECT_LT(length(cross(s, t) - n), 1e-5);
    }
}

TEST(Clip, FindsThePartInsideABox) {
    const Box3d box{{0, 0, 0}, {1, 1, 1}};
    const Interval i = clip({{-1, 0.5, 0.5}, {2, 0, 0}}, box);
    EXPECT_DOUBLE_EQ(i.t0, 0.5);
    EXPECT_DOUBLE_EQ(i.t1, 1.0);
    EXPECT_TRUE(clip({{-1, 2, 0.5}, {1, 0, 0}}, box).is_empty());
}

TEST(MonotoneCubic, NeverLeavesTheRangeOfItsNeighboursAndReproducesLines) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        float f[4];
        for (std::uint32_t k = 0; k < 4; ++k) f[k] = random_uniform(random_key(9, i), k) * 4 - 2;
        for (float t = 0; t <= 1; t += 0.05f) {
            const float v = monotone_cubic(f[0], f[1], f[2], f[3], t);
            EXPECT_GE(v, std::min(f[1], f[2]) - 1e-5f);
            EXPECT_LE(v, std::max(f[1], f[2]) + 1e-5f);
        }
    }
    EXPECT_NEAR(monotone_cubic(-1, 0, 1, 2, 0.3f), 0.3f, 1e-6f);
}

TEST(Keyed, InterpolatesBetweenKeysAndStaysOutside) {
    const Keyed<double> k({0, 1, 3}, {0, 5, 1});
    EXPECT_DOUBLE_EQ(k.at(-1), 0);
    EXPECT_DOUBLE_EQ(k.at(0.5), 2.5);
    EXPECT_DOUBLE_EQ(k.at(2), 3);
    EXPECT_DOUBLE_EQ(k.at(9), 1);
    EXPECT_NEAR(k.rate(0.5), 5, 1e-9);
    EXPECT_DOUBLE_EQ(Keyed<double>(4.0).at(7), 4);
}

TEST(GradientNoise, VanishesOnTheLatticeIsBoundedAndHasNoMean) {
    RunningStatistics s;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const std::uint64_t key = random_key(5, i);
        const Vec3d p(50.0 * random_uniform(key, 0), 50.0 * random_uniform(key, 1),
                      50.0 * random_uniform(key, 2));
        const float n = gradient_noise(p, 1);
        ASSERT_LE(std::abs(n), 1.04f);  // the bound of Perlin's edge gradients in 3-D
        s.add(n);
    }
    EXPECT_EQ(gradient_noise({3, -2, 7}, 1), 0);
    EXPECT_LT(std::abs(s.mean),
              4 * s.standard_error() + 0.01);  // samples share lattice cells, hence the margin
    EXPECT_GT(s.variance(), 0.03);
}

TEST(GaussLegendre, IntegratesPolynomialsExactly) {
    EXPECT_NEAR(GaussLegendre(5).integrate(0, 2, [](double x) { return std::pow(x, 9); }), 102.4,
                1e-10);
    EXPECT_NEAR(GaussLegendre(20).integrate(0, pi, [](double x) { return std::sin(x); }), 2, 1e-13);
}

// A (0,2)-sequence puts exactly one of 2^m consecutive points into each elementary interval;
// scrambling keeps that.
TEST(Sobol, PutsOnePointInEachElementaryInterval) {
    for (const std::uint32_t seed : {0u, 1u, 77u}) {
        for (int mx = 0; mx <= 8; ++mx) {
            std::vector<int> count(256);
            for (std::uint32_t i = 0; i < 256; ++i) {
                const Vec2f p = sobol_2d(i, seed);
                const int x = static_cast<int>(p.x * static_cast<float>(1 << mx));
                const int y = static_cast<int>(p.y * static_cast<float>(1 << (8 - mx)));
                ++count[static_cast<std::size_t>(x * (1 << (8 - mx)) + y)];
            }
            for (const int n : count) ASSERT_EQ(n, 1);
        }
    }
}

}  // namespace
}  // namespace gischt
