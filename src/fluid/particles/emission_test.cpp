// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/emission.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace gischt {
namespace {

struct Given {
    Particles particles;
    std::vector<double> birth;
};

Given emit_all(const SpoutParams& p, double seconds, int steps, const Mesh& mesh = {}) {
    const Spout spout(p, mesh, 0, 5);
    Given g;
    for (int i = 0; i < steps; ++i) {
        spout.emit(seconds * i / steps, seconds * (i + 1) / steps, g.particles, g.birth);
    }
    return g;
}

Keyed<double> keys(KeyInterpolation kind) {
    return {{-0.5, 0.3, 0.6, 2.0}, {10, 400, 0, 700}, kind};
}

TEST(RateIntegral, IsTheIntegralOfTheRateAndItsInverse) {
    for (const auto kind :
         {KeyInterpolation::Step, KeyInterpolation::Linear, KeyInterpolation::Smooth}) {
        const Keyed<double> rate = keys(kind);
        const RateIntegral integral(rate);
        double sum = 0;
        constexpr int n = 300000;  // midpoints over 3 s; a step falls between two of them
        for (int i = 0; i < n; ++i) {
            sum += rate.at(3.0 * (i + 0.5) / n) * 3 / n;
            if (i % 1000 != 999) continue;
            const double t = 3.0 * (i + 1) / n;
            ASSERT_NEAR(integral.at(t), sum, 1e-5) << t;
            ASSERT_NEAR(integral.at(integral.time_of(sum, 0, 3)), sum, 1e-4);
        }
    }
    EXPECT_THROW(RateIntegral(Keyed<double>(-1)), Error);
}

TEST(Spout, GivesTheIntegralOfTheRateEvenly) {
    SpoutParams p;
    p.rate = keys(KeyInterpolation::Smooth);
    const RateIntegral integral(p.rate);
    const Given g = emit_all(p, 3, 10);
    EXPECT_GT(g.birth.size(), 500u);
    // Up to any moment the number is the integral to within one.
    for (std::size_t i = 0; i < g.birth.size(); ++i) {
        if (i > 0) {
            EXPECT_GT(g.birth[i], g.birth[i - 1]);
        }
        EXPECT_NEAR(integral.at(g.birth[i]), static_cast<double>(i) + 0.5, 0.5001);
    }
}

TEST(Spout, GivesTheSameInAnyNumberOfSteps) {
    SpoutParams p;
    p.kind = SpoutKind::Ball;
    p.rate = keys(KeyInterpolation::Linear);
    p.position = Keyed<Vec3d>({0, 3}, {Vec3d(), Vec3d(6, 0, 0)});
    p.inherit = 1;
    p.cone_degrees = 20;
    p.speed_spread = p.life_spread = p.radius_spread = 0.3;
    const Given one = emit_all(p, 3, 1), many = emit_all(p, 3, 777);
    ASSERT_EQ(one.particles.id, many.particles.id);
    EXPECT_EQ(one.particles.radius, many.particles.radius);
    for (std::size_t i = 0; i < one.birth.size(); ++i) {
        EXPECT_NEAR(one.birth[i], many.birth[i], 1e-12);
        EXPECT_LT(length(one.particles.position[i] - many.particles.position[i]), 1e-11);
        EXPECT_LT(length(one.particles.velocity[i] - many.particles.velocity[i]), 1e-5f);
    }
}

// Means of n values of the standard deviation s scatter by s / sqrt(n); the bounds are 5 of those.
TEST(Spout, FillsItsShapeEvenly) {
    SpoutParams p;
    p.rate = 20000;
    p.radius = 2;
    p.position = Vec3d(1, 0, 0);
    p.direction = Vec3d(0, 3, 0);
    const double n = 20000, bound = 5 / std::sqrt(n);
    p.kind = SpoutKind::Disc;
    double r2 = 0, x = 0;
    const Given disc = emit_all(p, 1, 3);
    for (const Vec3d& q : disc.particles.position) {
        EXPECT_NEAR(q.y, 0, 1e-12);
        r2 += dot(q - Vec3d(1, 0, 0), q - Vec3d(1, 0, 0)) / n;
        x += q.x / n;
    }
    EXPECT_NEAR(r2, 2, 4 / std::sqrt(12) * bound);
    EXPECT_NEAR(x, 1, bound);
    p.kind = SpoutKind::Ball;
    double r = 0;
    for (const Vec3d& q : emit_all(p, 1, 3).particles.position) r += length(q - Vec3d(1, 0, 0)) / n;
    EXPECT_NEAR(r, 1.5, 2 * std::sqrt(3.0 / 80) * bound);
}

TEST(Spout, GivesByLengthAndByArea) {
    SpoutParams p;
    p.rate = 20000;
    const double n = 20000, bound = 5 * std::sqrt(0.25 * 0.75 * n);
    p.kind = SpoutKind::Curve;
    p.radius = 0;
    p.points = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}};
    double first = 0;
    for (const Vec3d& q : emit_all(p, 1, 1).particles.position) first += q.y == 0 && q.x < 1;
    EXPECT_NEAR(first, n / 4, bound);

    Mesh mesh;  // triangles of area 1/2 and 3/2, facing up and down
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {0, 3, 5}, {1, 0, 5}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    p.kind = SpoutKind::Mesh;
    p.along_normal = true;
    p.speed = 2;
    first = 0;
    double x = 0;
    const Given g = emit_all(p, 1, 1, mesh);
    for (std::size_t i = 0; i < g.particles.size(); ++i) {
        const Vec3d& q = g.particles.position[i];
        first += q.z < 1;
        x += q.x / n;
        EXPECT_NEAR(g.particles.velocity[i].z, q.z < 1 ? 2 : -2, 1e-6);
    }
    EXPECT_NEAR(first, n / 4, bound);
    EXPECT_NEAR(x, 1.0 / 3, std::sqrt(1.0 / 18) * 5 / std::sqrt(n));
}

TEST(Spout, SpreadsEvenlyOverItsCone) {
    SpoutParams p;
    p.rate = 20000;
    p.cone_degrees = 60;
    p.direction = Vec3d(0, 0, -2);
    double cosine = 0;
    for (const Vec3f& v : emit_all(p, 1, 1).particles.velocity) {
        EXPECT_NEAR(length(v), 1, 1e-5);
        EXPECT_LE(v.z, -0.4999f);
        cosine -= static_cast<double>(v.z) / 20000;
    }
    EXPECT_NEAR(cosine, 0.75, 0.5 / std::sqrt(12) * 5 / std::sqrt(20000));
}

TEST(Spout, RefusesWhatGivesNothing) {
    SpoutParams p;
    p.kind = SpoutKind::Mesh;
    EXPECT_THROW(Spout(p, {}, 0, 1), Error);
    p.kind = SpoutKind::Curve;
    p.points = {{1, 1, 1}, {1, 1, 1}};
    EXPECT_THROW(Spout(p, {}, 0, 1), Error);
    p = {};
    p.direction = Vec3d();
    EXPECT_THROW(Spout(p, {}, 0, 1), Error);
}

}  // namespace
}  // namespace gischt
