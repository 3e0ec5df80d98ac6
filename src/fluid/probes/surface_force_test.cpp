// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/surface_force.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "fluid/probes/test_smoke.h"

namespace gischt {
namespace {

SolidParams ball(const Vec3d& center, double radius) {
    SolidParams s;
    s.position = center;
    s.radius = radius;
    return s;
}

// Relative root mean square error of Archimedes' force over balls at places off the grid.
double archimedes_error(int resolution, bool is_2d) {
    const double radius = 0.23;
    const Vec3d gradient(1.3, -0.7, is_2d ? 0.0 : 2.1);  // Pa/m
    const double size = is_2d ? pi * radius * radius : 4 * pi / 3 * radius * radius * radius;
    double sum = 0;
    int count = 0;
    for (int place = 0; place < (is_2d ? 16 : 3); ++place) {
        const double shift = 0.0037 * place;
        FluidWorld world = still_world();
        world.solids = {
            ball({0.5 + shift, 0.47 - 0.3 * shift, is_2d ? 0 : 0.51 + 0.7 * shift}, radius)};
        SmokeSolver solver(unit_domain(resolution, is_2d), world);
        set_pressure(solver, [&](const Vec3d& p) { return 50 + dot(gradient, p); });
        const SolidForce f = measure_solid_force(solver, 0, true);
        const Vec3d error = f.pressure + size * gradient;
        EXPECT_EQ(f.viscous, Vec3d());
        EXPECT_LT(length(f.torque), 0.02 * radius * size * length(gradient));
        sum += dot(error, error) / (size * size * dot(gradient, gradient));
        ++count;
    }
    return std::sqrt(sum / count);
}

TEST(SolidForce, IsArchimedesForceInALinearPressure) {
    for (const bool is_2d : {true, false}) {
        // A circle of 4 cells' radius is hit by chance: the order shows from 8 on.
        const int cells = is_2d ? 32 : 16;
        const double coarse = archimedes_error(cells, is_2d),
                     middle = archimedes_error(2 * cells, is_2d),
                     fine = archimedes_error(4 * cells, is_2d);
        const double order = 0.5 * std::log2(coarse / fine);
        fmt::print("  {}: errors {:.2e} {:.2e} {:.2e}, order {:.2f}\n", is_2d ? "circle" : "ball",
                   coarse, middle, fine, order);
        EXPECT_LT(middle, 0.01);
        EXPECT_GT(order, 1.8);
    }
}

TEST(SolidForce, IsThatOfTheNamedSolid) {
    FluidWorld world = still_world();
    world.solids = {ball({0.3, 0.5, 0}, 0.12), ball({0.7, 0.5, 0}, 0.17)};
    SmokeSolver solver(unit_domain(64, true), world);
    set_pressure(solver, [](const Vec3d& p) { return p.y; });
    for (const std::size_t s : {0u, 1u}) {
        const double r = world.solids[s].radius.at(0);
        EXPECT_NEAR(measure_solid_force(solver, s, true).pressure.y, -pi * r * r,
                    0.01 * pi * r * r);
    }
    EXPECT_THROW(measure_solid_force(solver, 2, true), Error);
}

// A linear shear along a plane at any offset and angle: traction mu times the shear rate.
TEST(SolidForce, IsTheFrictionOfAShearFlowOnAPlane) {
    for (const double degrees : {0.0, 20.0}) {
        for (const double offset : {0.13, 0.2, 0.2371}) {
            const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
            const Vec3d normal(-s, c, 0), along(c, s, 0), foot(0.5, 0.15 + offset, 0);
            SolidParams plane;
            plane.kind = SolidKind::Plane;
            plane.normal = normal;
            plane.position = foot;
            FluidWorld world = still_world();
            world.solids = {plane};
            SmokeParams params = unit_domain(32, true, SideKind::Open);
            params.viscosity = 0.01;
            params.solid_slip = SolidSlip::NoSlip;
            SmokeSolver solver(params, world);
            const double rate = 3;
            set_velocity(solver,
                         [&](const Vec3d& p) { return rate * dot(p - foot, normal) * along; });
            const SolidForce f = measure_solid_force(solver, 0, true);
            const double expected = params.reference_density * params.viscosity * rate / c;
            EXPECT_NEAR(dot(f.viscous, along), expected, 2e-4 * expected) << degrees << offset;
            EXPECT_NEAR(dot(f.viscous, normal), 0, 2e-4 * expected);
            EXPECT_EQ(measure_solid_force(solver, 0, false).viscous, Vec3d());
        }
    }
}

// u_phi = B (1/r - r/R^2) around a cylinder at rest: torque -4 pi mu B per metre.
TEST(SolidForce, IsTheTorqueOfARotatingFluid) {
    const double radius = 0.2, strength = 0.5;
    const Vec3d center(0.513, 0.488, 0);
    std::vector<double> errors;
    for (const int n : {32, 64, 128}) {
        FluidWorld world = still_world();
        world.solids = {ball(center, radius)};
        SmokeParams params = unit_domain(n, true);
        params.viscosity = 0.02;
        params.solid_slip = SolidSlip::NoSlip;
        SmokeSolver solver(params, world);
        set_velocity(solver, [&](const Vec3d& p) {
            const Vec3d arm = p - center;
            const double r = std::hypot(arm.x, arm.y);
            const double speed = strength * (1 / r - r / (radius * radius));
            return Vec3d(-arm.y / r, arm.x / r, 0) * speed;
        });
        const double mu = params.reference_density * params.viscosity,
                     truth = -4 * pi * mu * strength;
        const SolidForce f = measure_solid_force(solver, 0, true);
        errors.push_back(std::abs(f.torque.z / truth - 1));
        EXPECT_LT(length(f.viscous), 0.01 * std::abs(truth) / radius);
    }
    const double order = 0.5 * std::log2(errors[0] / errors[2]);
    fmt::print("  torque: errors {:.2e} {:.2e} {:.2e}, order {:.2f}\n", errors[0], errors[1],
               errors[2], order);
    EXPECT_LT(errors[2], 0.01);
    EXPECT_GT(order, 1.7);
}

}  // namespace
}  // namespace gischt
