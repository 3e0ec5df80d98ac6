// SPDX-License-Identifier: Apache-2.0
#include "shape/solid_angle.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"
#include "math/sobol.h"

namespace gischt {
namespace {

// A cube around a point: each face fills a sixth of the sphere, from anywhere all six fill it.
TEST(SolidAngle, FacesOfACubeFillTheSphere) {
    const auto face = [](const Vec3d& from, int axis, double side) {
        Vec3d corner(-1), x, y;
        corner[axis] = side;
        x[(axis + 1) % 3] = 2;
        y[(axis + 2) % 3] = 2;
        return SphericalRectangle(from, corner, x, y).solid_angle();
    };
    EXPECT_NEAR(face({}, 2, 1), 4 * pi / 6, 1e-12);
    for (std::uint32_t i = 0; i < 100; ++i) {
        const std::uint64_t key = random_key(1, i);
        const auto u = [&](std::uint32_t d) { return 1.98 * random_uniform(key, d) - 0.99; };
        const Vec3d from{u(0), u(1), u(2)};
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) sum += face(from, axis, 1) + face(from, axis, -1);
        ASSERT_NEAR(sum, 4 * pi, 1e-9);
    }
    EXPECT_EQ(face({0, 0, 1}, 2, 1), 0);
}

TEST(SolidAngle, TrianglesMakeTheRectangle) {
    for (std::uint32_t i = 0; i < 100; ++i) {
        const std::uint64_t key = random_key(2, i);
        const auto u = [&](std::uint32_t d) { return 4.0 * random_uniform(key, d) - 2; };
        const Vec3d from{u(0), u(1), u(2)}, a{-0.5, -0.3, 0}, x{1, 0, 0}, y{0, 0.7, 0};
        const double whole = SphericalRectangle(from, a, x, y).solid_angle();
        const double parts = triangle_solid_angle(from, a, a + x, a + x + y) +
                             triangle_solid_angle(from, a, a + x + y, a + y);
        ASSERT_NEAR(whole, parts, 1e-11);
    }
    // An octant, and from far away area over squared distance.
    EXPECT_NEAR(triangle_solid_angle({}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), pi / 2, 1e-12);
    EXPECT_NEAR(triangle_solid_angle({0, 0, 1e4}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}) * 1e8, 0.5,
                1e-6);
}

TEST(SolidAngle, DiscMeetsTheConeOnItsAxis) {
    for (const double h : {0.1, 0.5, 2.0, 1e3}) {
        const double exact = 2 * pi / (std::hypot(h, 0.7) * (std::hypot(h, 0.7) + h)) * 0.49;
        EXPECT_NEAR(disc_solid_angle({1, 2, 3 + h}, {1, 2, 3}, {0, 0, 1}, 0.7) / exact, 1, 1e-9);
    }
    // Off the axis: the sum of thin triangles of a fine polygon.
    const Vec3d from{1.3, -0.4, 0.6};
    double sum = 0;
    constexpr int n = 4096;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * pi * i / n, b = 2 * pi * (i + 1) / n;
        sum += triangle_solid_angle(from, {0, 0, 0}, {std::cos(a), std::sin(a), 0},
                                    {std::cos(b), std::sin(b), 0});
    }
    EXPECT_NEAR(disc_solid_angle(from, {}, {0, 0, 1}, 1), sum, 2e-6);
}

// Samples lie on the shape, and any part of it receives its share of the solid angle: 2^14 points
// of a (0,2)-sequence have a discrepancy near 1e-3.
TEST(SolidAngle, SamplesAreEven) {
    constexpr std::uint32_t n = 1 << 14;
    const Vec3d corner{-0.5, -0.3, 0}, x{1, 0, 0}, y{0, 0.7, 0};
    for (const Vec3d& from : {Vec3d{0.1, 0, 0.05}, Vec3d{0.3, 0.2, -0.4}, Vec3d{3, 1, 2}}) {
        const SphericalRectangle whole(from, corner, x, y), part(from, corner, 0.37 * x, 0.62 * y);
        const SphericalTriangle triangle(from, corner, corner + x, corner + y);
        const Vec3d inner = corner + 0.3 * x, outer = corner + 0.8 * y;
        const double share = triangle_solid_angle(from, corner, inner, outer);
        double in_part = 0, in_triangle = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            const Vec3d p = whole.point(sobol_2d(i, 3));
            ASSERT_NEAR(p.z, 0, 1e-12);
            const Vec3d q = p - corner;
            ASSERT_TRUE(q.x >= -1e-9 && q.x <= 1 + 1e-9 && q.y >= -1e-9 && q.y <= 0.7 + 1e-9);
            in_part += q.x < 0.37 && q.y < 0.62 * 0.7;
            const Vec3d d = triangle.direction(sobol_2d(i, 4));
            ASSERT_NEAR(length(d), 1, 1e-9);
            const Vec3d r = from - (from.z / d.z) * d - corner;
            ASSERT_TRUE(r.x >= -1e-7 && r.y >= -1e-7 && r.x + r.y / 0.7 <= 1 + 1e-7);
            in_triangle += r.x / 0.3 + r.y / (0.8 * 0.7) < 1;
        }
        EXPECT_NEAR(in_part / n, part.solid_angle() / whole.solid_angle(), 3e-3);
        EXPECT_NEAR(in_triangle / n, share / triangle.solid_angle(), 3e-3);
    }
}

}  // namespace
}  // namespace gischt
