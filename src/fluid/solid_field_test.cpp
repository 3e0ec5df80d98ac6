// SPDX-License-Identifier: Apache-2.0
#include "fluid/solid_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fluid/smoke.h"

namespace gischt {
namespace {

SolidParams sphere(const Vec3d& at, double radius) {
    SolidParams s;
    s.position = at;
    s.radius = radius;
    return s;
}

SolidParams plane(const Vec3d& at, const Vec3d& normal) {
    SolidParams s;
    s.kind = SolidKind::Plane;
    s.position = at;
    s.normal = normal;
    return s;
}

SolidParams tilted_box(const Vec3d& at, const Vec3d& size) {
    SolidParams s;
    s.kind = SolidKind::Box;
    s.position = at;
    s.size = size;
    s.rotation = Vec3d(20, 30, -10);
    return s;
}

TEST(OpenFraction, IsExactForPlanes) {
    // A distance that is linear on the unit square; the area by 512^2 points.
    for (const Vec3d g : {Vec3d(1, 0.3, -0.4), Vec3d(-0.7, 0.2, 0.1), Vec3d(0.5, 0.5, -0.9)}) {
        const auto phi = [&](double x, double y) { return g.x * x + g.y * y + g.z; };
        int inside = 0;
        for (int i = 0; i < 512; ++i) {
            for (int j = 0; j < 512; ++j) inside += phi((i + 0.5) / 512, (j + 0.5) / 512) > 0;
        }
        const auto f = [&](double x, double y) { return static_cast<float>(phi(x, y)); };
        EXPECT_NEAR(open_fraction(f(0, 0), f(1, 0), f(1, 1), f(0, 1)), inside / (512.0 * 512.0),
                    2e-3);
    }
    EXPECT_EQ(open_fraction(1, 1, 1, 1), 1);
    EXPECT_EQ(open_fraction(-1, -1, -1, -1), 0);
    EXPECT_FLOAT_EQ(open_fraction(-1, 1, 1, -1), 0.5f);
}

// The flux of a uniform flow through the open faces of a column of cells is the flow past the
// solid: the open areas of a cross-section add up to the plane minus the disk.
TEST(SolidField, CutsADiskOutOfACrossSection) {
    DomainParams params;
    params.resolution = 48;
    const Domain domain(params);
    const BlockMap blocks(domain.map);
    const SolidField solids(domain, blocks, {sphere({0.5, 0.52, 0.5}, 0.3)});
    for (int a = 0; a < 3; ++a) {
        double open = 0;
        Vec3i f;
        f[a] = 24;
        for (int j = 0; j < 48; ++j) {
            for (int i = 0; i < 48; ++i) {
                f[(a + 1) % 3] = i;
                f[(a + 2) % 3] = j;
                open += solids.fraction().get(a, f);
            }
        }
        const double offset = a == 1 ? 0.02 : 0.0;
        const double disk = pi * (0.09 - offset * offset);
        EXPECT_NEAR(1 - open / (48.0 * 48.0), disk, 0.002 * disk);
    }
}

TEST(SolidParams, MovesLikeARigidBody) {
    SolidParams s = tilted_box({0, 0, 0}, {1, 2, 3});
    s.position = Keyed<Vec3d>({0, 1}, {Vec3d(0), Vec3d(2, 0, 0)});
    s.rotation = Keyed<Vec3d>({0, 1}, {Vec3d(0), Vec3d(0, 0, 90)});
    const Vec3d v = s.velocity_at(0.5, Vec3d(1, 0, 0) + Vec3d(0, 0.5, 0));
    EXPECT_NEAR(v.x, 2 - 0.5 * pi / 2, 1e-5);
    EXPECT_NEAR(v.y, 0, 1e-5);
    EXPECT_NEAR(v.z, 0, 1e-9);
}

// A uniform flow that meets a cylinder becomes the potential flow: 1 + R^2/r^2 beside it.
TEST(PressureProjection, GivesPotentialFlowAroundACylinder) {
    SmokeParams params;
    params.domain.resolution = 200;
    params.domain.min = {-1, -1, 0};
    params.domain.max = {1, 1, 0};
    params.pressure_tolerance = 1e-6;
    params.initial_velocity = {1, 0, 0};
    FluidWorld world;
    world.solids = {sphere({0.003, 0.001, 0}, 0.1)};
    const SmokeSolver solver(params, world);
    const Domain& d = solver.domain();
    for (const double y : {0.115, -0.135, 0.205, 0.305}) {
        const Vec3i face{100, static_cast<int>(std::floor((y + 1) / d.h)), 0};
        const Vec3d r = d.face_center(0, face) - Vec3d(0.003, 0.001, 0);
        const double r2 = r.x * r.x + r.y * r.y;
        const double exact = 1 - 0.01 * (r.x * r.x - r.y * r.y) / (r2 * r2);
        // The open sides, ten radii away, change the flow by about (R / L)^2.
        EXPECT_NEAR(solver.state().velocity.get(0, face), exact, 0.02) << y;
    }
}

class Obstacle : public testing::TestWithParam<SolidParams> {};

// No fluid enters a solid: each cell's fluxes add up to zero, the closed part of a face counting
// with the velocity of the solid.
TEST_P(Obstacle, LetsNothingThrough) {
    SmokeParams params;
    params.domain.resolution = 32;
    params.domain.y_min = params.domain.y_max = SideKind::FreeSlip;
    params.initial_velocity = {1, 0.3, -0.5};
    params.pressure_tolerance = 1e-6;
    FluidWorld world;
    world.gravity = {};
    world.solids = {GetParam()};
    SmokeSolver solver(params, world);
    Job job;
    for (int s = 0; s < 3; ++s) {
        const StepStatistics stats = solver.step(0.02, job);
        EXPECT_TRUE(stats.solve.converged);
        EXPECT_LT(stats.max_divergence_dt, 1e-5);
        EXPECT_LT(stats.max_speed, 10);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Solids, Obstacle,
    testing::Values(
        sphere({0.5, 0.5, 0.5}, 0.21), tilted_box({0.5, 0.45, 0.5}, {0.3, 0.4, 0.2}),
        plane({0.5, 0.5, 0.2}, {0.2, 0.1, 1}), [] {
            SolidParams s = sphere({0.4, 0.5, 0.5}, 0.15);
            s.position = Keyed<Vec3d>({0, 1}, {Vec3d(0.4, 0.5, 0.5), Vec3d(0.8, 0.5, 0.5)});
            return s;
        }()));

// Buoyant fluid between two walls tilted by 30 degrees stays at rest: the pressure is linear, and
// the cut faces see its exact gradient.
TEST(SolidField, HoldsFluidBetweenTiltedWalls) {
    SmokeParams params;
    params.domain.resolution = 64;
    params.domain.max = {1, 1, 0};
    params.domain.set_all_sides(SideKind::FreeSlip);
    params.pressure_tolerance = 1e-6;
    const Vec3d up{std::sin(pi / 6), std::cos(pi / 6), 0};
    FluidWorld world;
    world.gravity = {0, -9.81, 0};
    world.solids = {plane({0.5, 0.3, 0}, up), plane({0.5, 0.75, 0}, -up)};
    SmokeSolver solver(params, world);
    Job job;
    solver.fill({.velocity = nullptr,
                 .density = nullptr,
                 .temperature = [](const Vec3d&) { return 586.3; }},
                job);
    for (int s = 0; s < 5; ++s) {
        // T = 2 T_ambient: the fluid would gain 9.81 m/s per second.
        EXPECT_LT(solver.step(0.02, job).max_speed, 0.02 * 9.81 * 1e-4);
    }
}

TEST(SolidField, KeepsScalarsOutOfSolids) {
    SmokeParams params;
    params.domain.resolution = 32;
    params.domain.set_all_sides(SideKind::FreeSlip);
    params.initial_velocity = {0, 0, 0};
    FluidWorld world;
    world.gravity = {};
    world.solids = {sphere({0.5, 0.5, 0.3}, 0.2)};
    SmokeSolver solver(params, world);
    Job job;
    // Smoke everywhere outside: next to a solid whose inside holds none it must not thin out.
    solver.fill(
        {.velocity = [](const Vec3d& p) { return Vec3d(0.5 - p.y, p.x - 0.5, 0); },
         .density =
             [&](const Vec3d& p) { return solver.solids().signed_distance(p) < 0 ? 0.0 : 1.0; },
         .temperature = nullptr},
        job);
    for (int s = 0; s < 10; ++s) solver.step(0.05, job);
    for (int k = 0; k < 32; ++k) {
        for (int i = 0; i < 32; ++i) {
            const Vec3i c{i, 16, k};
            if (solver.solids().signed_distance(solver.domain().center_of(c)) < 0) continue;
            EXPECT_NEAR(solver.state().density.values.get(c), 1, 1e-5);
        }
    }
}

TEST(SolidField, RefusesImpossibleSolids) {
    DomainParams params;
    params.resolution = 16;
    const Domain domain(params);
    const BlockMap blocks(domain.map);
    EXPECT_THROW(SolidField(domain, blocks, {sphere({}, 0)}), Error);
    EXPECT_THROW(SolidField(domain, blocks, {plane({}, {0, 0, 0})}), Error);
    EXPECT_THROW(SolidField(domain, blocks, {tilted_box({}, {1, 0, 1})}), Error);
}

}  // namespace
}  // namespace gischt
