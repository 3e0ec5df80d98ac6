// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"

namespace gischt {
namespace {

constexpr double g = 9.80665;
const Vec3d down(0, 0, -g);

struct Drop {
    MotionParams motion;
    AirParams air;
    Vec3d gravity = down;
    std::vector<SolidParams> solids;

    // The motion after `seconds` in so many steps.
    PointMotion run(PointMotion p, double seconds, int steps, double radius = 0) const {
        const Air moving(air);
        Mover mover(motion, gravity, moving, solids);
        for (int i = 0; i < steps; ++i) {
            const double from = seconds * i / steps, to = seconds * (i + 1) / steps;
            mover.begin_step(to);
            mover.advance(p, radius, from, to - from);
        }
        return p;
    }
};

SolidParams ground() {
    SolidParams s;
    s.kind = SolidKind::Plane;
    return s;
}

TEST(Mover, ThrowsParabolasInAnyNumberOfSteps) {
    const Vec3d x(1, 2, 3), v(4, 5, 6);
    for (const int steps : {1, 7, 1000}) {
        const PointMotion p = Drop{}.run({x, v}, 2, steps);
        EXPECT_LT(length(p.position - (x + 2.0 * v + 2.0 * down)), 1e-11);
        EXPECT_LT(length(p.velocity - (v + 2.0 * down)), 1e-11);
    }
}

TEST(Mover, LinearDragRelaxesToTheWindExactly) {
    for (const double k : {1e-9, 1e-6, 1e-3, 0.5, 3.0, 1e6}) {
        Drop s;
        s.motion.linear_drag = k;
        s.air.wind = Vec3d(2, 0, 0);
        const Vec3d v(0, 1, 5), end = Vec3d(2, 0, 0) + down / k;
        const double t = 1.5, e = std::exp(-k * t);
        for (const int steps : {1, 10}) {
            const PointMotion p = s.run({{}, v}, t, steps);
            if (k < 1e-5) {  // the closed form cancels; it is free fall to about k t g t^2
                EXPECT_LT(length(p.velocity - (v + t * down)), 40 * k);
                EXPECT_LT(length(p.position - (t * v + (t * t / 2) * down)), 40 * k);
                continue;
            }
            EXPECT_LT(length(p.velocity - (end + e * (v - end))), 1e-10) << k;
            EXPECT_LT(length(p.position - (t * end + ((1 - e) / k) * (v - end))), 1e-8) << k;
        }
    }
}

// Falling from rest: v = v_end tanh(g t / v_end), and log2 of the fall of the error is the order.
TEST(Mover, QuadraticDragConvergesToTheClosedForm) {
    Drop s;
    s.motion.quadratic_drag = 0.4;
    const double top = std::sqrt(g / 0.4), exact = top * std::tanh(g * 0.6 / top);
    const auto error = [&](int steps) {
        return std::abs(-s.run({}, 0.6, steps).velocity.z - exact);
    };
    EXPECT_LT(error(64), 1e-3);
    EXPECT_GT(std::log2(error(32) / error(64)), 1.8);
    EXPECT_GT(std::log2(error(64) / error(128)), 1.8);
    // Slowing down alone: v = v0 / (1 + q v0 t), x = ln(1 + q v0 t) / q.
    s.gravity = {};
    const auto coasting = [&](int steps) { return s.run({{}, {20, 0, 0}}, 1, steps); };
    EXPECT_NEAR(coasting(400).velocity.x, 20 / 9.0, 1e-3);
    EXPECT_NEAR(coasting(400).position.x, std::log(9.0) / 0.4, 1e-3);
}

TEST(Mover, KeepsTheTerminalVelocityAndReachesItInOneLongStep) {
    Drop s;
    s.motion.quadratic_drag = 0.3;
    s.motion.linear_drag = 0.7;
    s.air.wind = Vec3d(3, -1, 0);
    // q w^2 + k w = g.
    const double w = (-0.7 + std::sqrt(0.49 + 4 * 0.3 * g)) / 0.6;
    const Vec3d end(3, -1, -w);
    for (const int steps : {1, 5, 50}) {
        EXPECT_LT(length(s.run({{}, end}, 4, steps).velocity - end), 1e-12);
    }
    EXPECT_LT(length(s.run({{}, {0, 0, 300}}, 1e4, 3).velocity - end), 1e-2);
}

// A tracer circles: the third order shows in the angle and in the radius.
TEST(Mover, TracersCircleAroundAVortex) {
    Drop s;
    s.motion.kind = ParticleMotion::Tracer;
    s.air.vortices.resize(1);
    s.air.vortices[0].circulation = 2 * pi;
    s.air.vortices[0].core = 0.5;
    const double turn = 1 / 1.25;  // rad/s at radius 1
    const auto error = [&](int steps) {
        const Vec3d p = s.run({{1, 0, 0}, {}}, 3, steps).position;
        return length(p - Vec3d(std::cos(3 * turn), std::sin(3 * turn), 0));
    };
    EXPECT_LT(error(64), 1e-5);
    EXPECT_GT(std::log2(error(32) / error(64)), 2.7);
}

// A circular orbit around a softened centre closes after its period.
TEST(Mover, OrbitsAroundAnAttractor) {
    Drop s;
    s.gravity = {};
    s.motion.attractors.resize(1);
    s.motion.attractors[0].strength = 2.0;
    s.motion.attractors[0].core = 0.6;
    const double turn = std::sqrt(2 / std::pow(1.36, 1.5));
    const auto error = [&](int steps) {
        return length(s.run({{1, 0, 0}, {0, turn, 0}}, 2 * pi / turn, steps).position -
                      Vec3d(1, 0, 0));
    };
    EXPECT_LT(error(800), 2e-3);
    EXPECT_GT(std::log2(error(400) / error(800)), 1.8);
}

// Each leap is e^2 as high as the last, in whatever steps.
TEST(Mover, BouncesToTheHeightOfItsRestitution) {
    Drop s;
    s.solids = {ground()};
    s.motion.contact.restitution = 0.7;
    constexpr double radius = 0.05, height = 2;
    const double fall = std::sqrt(2 * height / g);
    double top = fall;  // time at which it is highest after n leaps
    for (int n = 1; n < 5; ++n) {
        top += (n == 1 ? 0 : fall * std::pow(0.7, n - 1)) + fall * std::pow(0.7, n);
        for (const int steps : {40, 333}) {
            const PointMotion p = s.run({{0, 0, height + radius}, {3, 0, 0}}, top, steps, radius);
            EXPECT_NEAR(p.position.z - radius, height * std::pow(0.7, 2 * n), 1e-8);
            EXPECT_NEAR(p.velocity.z, 0, 1e-8);
        }
    }
}

TEST(Mover, FrictionStopsWhatSlides) {
    Drop s;
    s.solids = {ground()};
    s.motion.contact.friction = 0.5;
    s.motion.contact.restitution = 0;
    const PointMotion start{{0, 0, 0.1}, {3, 0, 0}};
    const PointMotion end = s.run(start, 2, 2000, 0.1);
    EXPECT_EQ(length(end.velocity), 0);
    EXPECT_NEAR(end.position.x, 9 / (2 * 0.5 * g), 2e-3);
    EXPECT_NEAR(end.position.z, 0.1, 1e-8);
    s.motion.contact.friction = 0;
    EXPECT_NEAR(s.run(start, 2, 50, 0.1).position.x, 6, 1e-9);
}

// Whatever rains on a ball and a turned box never gets inside, not even of a thin one.
TEST(Mover, NothingEntersSolids) {
    Drop s;
    SolidParams ball, box;
    ball.radius = 0.5;
    box.kind = SolidKind::Box;
    box.position = Vec3d(0, 0, -1.5);
    box.size = Vec3d(4, 4, 0.1);
    box.rotation = Vec3d(12, 5, 0);
    s.solids = {ball, box, ground()};
    s.solids[2].position = Vec3d(0, 0, -3);
    for (std::uint64_t i = 0; i < 300; ++i) {
        const std::uint64_t key = random_key(3, i);
        PointMotion p{{2.0 * random_uniform(key, 0) - 1, 2.0 * random_uniform(key, 1) - 1, 2},
                      {0, 0, -8.0 * random_uniform(key, 2)}};
        const Air still{{}};
        Mover mover(s.motion, down, still, s.solids);
        const Transform to_box = box.rotation_at(0).inverse();
        const auto in_box = [&] { return to_box.vector(p.position - box.position.at(0)); };
        Vec3d before = in_box();
        for (int step = 0; step < 60; ++step) {
            mover.begin_step(step / 24.0);
            ASSERT_TRUE(mover.advance(p, 0.01, step / 24.0, 1 / 24.0));
            for (const SolidParams& solid : s.solids) {
                ASSERT_GT(signed_distance(solid.shape_at(0), p.position), 0.01 - 1e-7);
            }
            // To the other side of the box only around its edge, at 2 m.
            const Vec3d after = in_box();
            if (before.z > 0 && after.z < 0) {
                ASSERT_GT(std::max(std::abs(after.x), std::abs(after.y)), 1.9);
            }
            before = after;
        }
    }
}

TEST(Mover, AMovingSolidPushesAndAVanishingContactEnds) {
    Drop s;
    s.gravity = {};
    SolidParams wall;
    wall.kind = SolidKind::Box;
    wall.size = Vec3d(1);
    wall.position = Keyed<Vec3d>({0, 1}, {Vec3d(-1, 0, 0), Vec3d(1, 0, 0)});
    s.solids = {wall};
    s.motion.contact.restitution = 1;
    const PointMotion p = s.run({}, 1, 200);
    EXPECT_NEAR(p.velocity.x, 4, 0.05);  // twice the wall's 2 m/s
    s.motion.contact.kind = ContactKind::Vanish;
    s.solids = {ground()};
    const Air still{{}};
    Mover mover(s.motion, down, still, s.solids);
    mover.begin_step(1);
    PointMotion falling{{0, 0, 1}, {}};
    EXPECT_FALSE(mover.advance(falling, 0, 0, 1));
    EXPECT_NEAR(falling.position.z, 0, 1e-9);
    s.motion.linear_drag = -1;
    EXPECT_THROW(Mover(s.motion, down, still, s.solids), Error);
}

}  // namespace
}  // namespace gischt
