// SPDX-License-Identifier: Apache-2.0
#include "grid/flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace gischt {
namespace {

constexpr int cells = 48;
constexpr double edge = 2.0 / cells;

using Scalar = std::function<double(const Vec3d&)>;
using Vector = std::function<Vec3d(const Vec3d&)>;

// On [-1,1]^3.
Field scalar_field(const Scalar& value) {
    Field f;
    f.component.emplace_back(TileMap::box(Vec3i(cells)));
    f.to_world = Transform::scale_translate(edge, Vec3d(-1));
    for (int i = 0; i < cells * cells * cells; ++i) {
        const Vec3i c(i % cells, i / cells % cells, i / cells / cells);
        const Vec3d p = f.to_world.point(Vec3d(c) + Vec3d(0.5));
        f.component[0].ref(c) = static_cast<float>(value(p));
    }
    return f;
}

Field vector_field(const Vector& value) {
    Field f;
    for (int a = 0; a < 3; ++a) {
        Field one = scalar_field([&](const Vec3d& p) { return value(p)[a]; });
        f.to_world = one.to_world;
        f.component.push_back(std::move(one.component[0]));
    }
    return f;
}

// exp(-r^2 / 2 s^2), five cells wide, cut off where nothing is left of it.
double lump(const Vec3d& p) {
    constexpr double s = 5 * edge;
    const double r2 = dot(p, p) / (s * s);
    return r2 < 20 ? std::exp(-0.5 * r2) : 0;
}

double largest_error(const Field& got, const Scalar& expected) {
    double largest = 0;
    for (int i = 0; i < 40 * 40 * 40; ++i) {
        const Vec3d p = Vec3d(i % 40, i / 40 % 40, i / 1600) * 0.06 - Vec3d(1.17);
        // At the centres of cells, so that no interpolation comes in.
        const Vec3d cell = Vec3d(floor((p + Vec3d(1)) / Vec3d(edge))) + Vec3d(0.5);
        const Vec3d at = cell * edge - Vec3d(1);
        largest = std::max(largest, std::abs(static_cast<double>(got.sample(at)) - expected(at)));
    }
    return largest;
}

// Back and forth, by parts of a cell, also where the file holds velocity only where smoke is.
TEST(Flow, CarriesALumpAlongEvenly) {
    const Field density = scalar_field(lump);
    const Vec3d v(1.7, -0.9, 0.4);
    const Field everywhere = vector_field([&](const Vec3d&) { return v; });
    const Field inside = vector_field([&](const Vec3d& p) { return lump(p) > 0 ? v : Vec3d(); });
    Job job;
    for (const Field* velocity : {&everywhere, &inside}) {
        const Flow flow(*velocity, density, 0.2, job);
        EXPECT_NEAR(flow.fastest_content(), length(v), 1e-5);
        for (const double t : {-0.2, 0.013, 0.2}) {
            const Field moved = carried(density, flow, t, job);
            // Catmull-Rom on such a lump: within 2e-3 at worst, between cells; trilinear 1.5e-2.
            EXPECT_LT(largest_error(moved, [&](const Vec3d& p) { return lump(p - t * v); }), 3e-3)
                << t;
        }
    }
}

// The way is followed around, not straight on.
TEST(Flow, FollowsATurn) {
    const Vec3d center(0.25, 0, 0);
    const Field density = scalar_field([&](const Vec3d& p) { return lump(p - center); });
    const Field velocity = vector_field([](const Vec3d& p) { return cross(Vec3d(0, 0, 1), p); });
    Job job;
    // Two stages are off by t^3 / 6 of the radius of up to 0.8: 0.03 cells, times a slope of 0.12
    // per cell; straight ways by t^2 / 2, ten times as much.
    constexpr double angle = 0.2;
    const Flow flow(velocity, density, angle, job);
    const Field moved = carried(density, flow, angle, job);
    const Vec3d there(0.25 * std::cos(angle), 0.25 * std::sin(angle), 0);
    EXPECT_LT(largest_error(moved, [&](const Vec3d& p) { return lump(p - there); }), 7e-3);
}

// Smoke at rest stays, next to smoke that moves.
TEST(Flow, LeavesWhatRests) {
    const Field density = scalar_field(
        [](const Vec3d& p) { return lump(p - Vec3d(0.4, 0, 0)) + lump(p + Vec3d(0.4, 0, 0)); });
    const Field velocity = vector_field([](const Vec3d& p) {
        return p.x > 0 && lump(p - Vec3d(0.4, 0, 0)) > 0.01 ? Vec3d(0, 1, 0) : Vec3d();
    });
    Job job;
    const Flow flow(velocity, density, 0.3, job);
    const Field moved = carried(density, flow, 0.3, job);
    for (int i = 0; i < 10; ++i) {
        const Vec3d p = Vec3d(-0.4 - 0.5 * edge, (0.5 + i) * edge, 0.5 * edge);
        EXPECT_EQ(moved.sample(p), density.sample(p));
    }
    const Vec3d p(0.4 - 0.5 * edge, 0.3, 0.5 * edge);
    EXPECT_GT(moved.sample(p), 0.5f);
    EXPECT_LT(density.sample(p), 0.5f);
}

TEST(Flow, SurvivesSpeedsThatAreNoNumbersOrTooLarge) {
    const Field density = scalar_field(lump);
    constexpr double bad[] = {std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()};
    Job job;
    for (const double v : bad) {
        const Field velocity =
            vector_field([&](const Vec3d& p) { return Vec3d(p.x > 0 ? v : 0.1, 0, 0); });
        const Flow flow(velocity, density, 0.1, job);
        const Field moved = carried(density, flow, 0.1, job);
        for (const float d : moved.component[0].values()) {
            ASSERT_TRUE(d >= 0 && d <= 1.125f);
        }
    }
}

}  // namespace
}  // namespace gischt
