// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/air.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "math/noise.h"

namespace gischt {
namespace {

Vec3d any_point(std::uint64_t i, double size) {
    const std::uint64_t key = random_key(17, i);
    return size * Vec3d(random_uniform(key, 0), random_uniform(key, 1), random_uniform(key, 2));
}

EddyParams eddies() {
    EddyParams p;
    p.speed = 3.0;
    p.scale = 0.4;
    p.octaves = 3;
    return p;
}

// Second derivatives jump at the planes of the lattice, where the central difference is off by e /
// 0.1 m of the first ones; elsewhere the error is far below.
TEST(Eddies, HasNoDivergence) {
    const EddyParams p = eddies();
    constexpr double e = 1e-5;
    double largest_slope = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
        const Vec3d x = any_point(i, 10);
        double divergence = 0, slope = 0;
        for (int a = 0; a < 3; ++a) {
            Vec3d lo = x, hi = x;
            lo[a] -= e;
            hi[a] += e;
            const Vec3d d = (eddy_velocity(p, hi, 0.3) - eddy_velocity(p, lo, 0.3)) / (2 * e);
            divergence += d[a];
            slope += length(d);
        }
        largest_slope = std::max(largest_slope, slope);
        EXPECT_LT(std::abs(divergence), 2e-4 * slope + 1e-9);
    }
    EXPECT_GT(largest_slope, p.speed.at(0) / p.scale);
}

// The mean of v^2 of independent points scatters by its standard error: 5 of them.
TEST(Eddies, HasTheSpeedAsked) {
    for (const double time : {0.0, 0.7, 1.0}) {
        double sum = 0, squares = 0;
        constexpr int n = 40000;
        for (std::uint64_t i = 0; i < n; ++i) {
            const Vec3d v = eddy_velocity(eddies(), any_point(i, 1000), time);
            sum += dot(v, v);
            squares += dot(v, v) * dot(v, v);
        }
        const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
        EXPECT_NEAR(mean, 9, 5 * error);
        EXPECT_LT(error, 0.1);
    }
}

TEST(Eddies, ChangesWithoutJumps) {
    for (std::uint64_t i = 0; i < 50; ++i) {
        const Vec3d x = any_point(i, 5);
        const Vec3d before = eddy_velocity(eddies(), x, 2 - 1e-9),
                    after = eddy_velocity(eddies(), x, 2 + 1e-9);
        EXPECT_LT(length(after - before), 1e-6);
        EXPECT_GT(length(eddy_velocity(eddies(), x, 4) - after), 1e-3);
    }
}

// Integral of u.dl around a circle about the line.
double circulation(const VortexParams& v, double r) {
    constexpr int n = 360;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double phi = 2 * pi * i / n;
        const Vec3d out(std::cos(phi), std::sin(phi), 0), along(-out.y, out.x, 0);
        sum += dot(vortex_velocity(v, r * out, 0), along) * 2 * pi * r / n;
    }
    return sum;
}

TEST(Vortex, CirculatesAsAskedOutsideOfItsCore) {
    VortexParams v;
    v.circulation = 2.5;
    v.core = 0.1;
    for (const double r : {0.05, 0.1, 1.0, 10.0}) {
        EXPECT_NEAR(circulation(v, r), 2.5 * r * r / (r * r + 0.01), 1e-12) << r;
    }
    EXPECT_EQ(length(vortex_velocity(v, {0, 0, 3}, 0)), 0);
}

TEST(Vortex, OfALongLineOfPointsIsThatOfAStraightOne) {
    VortexParams straight, parts;
    for (int i = -10; i <= 10; ++i) parts.points.push_back({0, 0, 100.0 * i});
    const Vec3d p(0.3, 0.4, 7);
    // The missing ends beyond z = 1000 give less than (r / z)^2.
    EXPECT_LT(length(vortex_velocity(straight, p, 0) - vortex_velocity(parts, p, 0)),
              1e-6 * length(vortex_velocity(straight, p, 0)));
}

TEST(Vortex, RingBlowsAlongItsAxis) {
    VortexParams ring;
    ring.core = 1e-6;
    constexpr int n = 2000;
    for (int i = 0; i <= n; ++i) {
        const double phi = 2 * pi * (i % n) / n;
        ring.points.push_back({2 * std::cos(phi), 2 * std::sin(phi), 0});
    }
    for (const double z : {0.0, 1.0, 5.0}) {
        const Vec3d u = vortex_velocity(ring, {0, 0, z}, 0);
        const double expected = 4 / (2 * std::pow(4 + z * z, 1.5));
        EXPECT_NEAR(u.z, expected, 1e-5 * expected);
        EXPECT_LT(std::hypot(u.x, u.y), 1e-9);
    }
}

TEST(Air, AddsItsPartsAndRefusesWhatMakesNoSense) {
    AirParams p;
    p.wind = Vec3d(1, 2, 3);
    p.vortices.resize(2);
    p.turbulence = eddies();
    const Vec3d x(0.3, 0.2, 0.1);
    const Vec3d sum = Vec3d(1, 2, 3) + 2.0 * vortex_velocity(p.vortices[0], x, 0.5) +
                      eddy_velocity(p.turbulence, x, 0.5);
    EXPECT_LT(length(Air(p).velocity(x, 0.5) - sum), 1e-12);
    p.vortices[1].core = 0;
    EXPECT_THROW(Air{p}, Error);
    p.vortices[1] = {};
    p.vortices[1].points = {Vec3d()};
    EXPECT_THROW(Air{p}, Error);
}

}  // namespace
}  // namespace gischt
