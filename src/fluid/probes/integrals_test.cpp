// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/integrals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "fluid/probes/test_smoke.h"

namespace gischt {
namespace {

TEST(Energy, IsThatOfATaylorGreenVortex) {
    std::vector<double> errors;
    for (const int n : {32, 64}) {
        SmokeParams params = unit_domain(n, true, SideKind::Periodic);
        params.domain.max = {2 * pi, 2 * pi, 0};
        SmokeSolver solver(params, still_world());
        set_velocity(solver, [](const Vec3d& p) {
            return Vec3d(std::sin(p.x) * std::cos(p.y), -std::cos(p.x) * std::sin(p.y), 0);
        });
        const EnergySample s = measure_energy(solver);
        EXPECT_NEAR(s.kinetic_energy, params.reference_density * pi * pi, 1e-5);
        EXPECT_NEAR(s.max_speed, 1, 0.02);
        errors.push_back(std::abs(s.enstrophy / (2 * pi * pi) - 1));
    }
    EXPECT_LT(errors[0], 0.01);
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
}

// u = (-y, x, 0) / 2 turns with curl 1: enstrophy 1/2 of the volume; the mean of y^2 over a unit
// cube is 1/12, and (1 - h^2) / 12 over the middles of its cells.
TEST(Energy, IsThatOfSolidRotation) {
    SmokeSolver solver(unit_domain(20, false, SideKind::Open), still_world());
    set_velocity(solver, [](const Vec3d& p) { return Vec3d(0.5 - p.y, p.x - 0.5, 0) * 0.5; });
    const EnergySample s = measure_energy(solver);
    const double rho = solver.params().reference_density;
    const double h = solver.domain().h;
    EXPECT_NEAR(s.kinetic_energy, 0.5 * rho * 0.25 * 2 * (1 - h * h) / 12, 1e-6);
    // Where a side is open the velocity beyond is that of the side: the curl is less in half a
    // cell.
    EXPECT_NEAR(s.enstrophy, 0.5, 0.05);
}

TEST(Energy, LeavesOutWhatASolidCovers) {
    FluidWorld world = still_world();
    SolidParams plane;
    plane.kind = SolidKind::Plane;
    plane.normal = {1, 0, 0};
    plane.position = Vec3d(0.5, 0, 0);
    world.solids = {plane};
    SmokeSolver solver(unit_domain(32, true, SideKind::Open), world);
    set_velocity(solver, [](const Vec3d&) { return Vec3d(0, 2, 0); });
    const double rho = solver.params().reference_density;
    EXPECT_NEAR(measure_energy(solver).kinetic_energy, 0.5 * rho * 4 * 0.5, 1e-5);
}

TEST(Amount, OfABoxCutsCells) {
    for (const bool is_2d : {true, false}) {
        SmokeSolver solver(unit_domain(16, is_2d), still_world());
        const double ambient = solver.params().ambient_temperature;
        set_scalars(
            solver, [](const Vec3d&) { return 0.5; }, [&](const Vec3d&) { return ambient + 8; });
        const Box3d box{{0.21, 0.1, 0.3}, {0.63, 0.77, 0.9}};
        const double size = 0.42 * 0.67 * (is_2d ? 1 : 0.6);
        const AmountSample part = measure_amount(solver, box),
                           all = measure_amount(solver, std::nullopt);
        EXPECT_NEAR(part.volume, 0.5 * size, 1e-6);
        EXPECT_NEAR(part.mass, 0.5 * size * solver.params().reference_density, 1e-6);
        EXPECT_NEAR(part.heat, 8 * size, 1e-4);
        EXPECT_NEAR(all.volume, 0.5, 1e-6);
    }
}

TEST(Front, OfARampIsExactBelowTheCell) {
    SmokeSolver solver(unit_domain(24, true), still_world());
    const double ambient = solver.params().ambient_temperature;
    for (const Vec3d& way : {Vec3d(1, 0, 0), Vec3d(0, -1, 0), normalize(Vec3d(1, 2, 0))}) {
        for (const double at : {-0.62, 0.31, 0.437, 0.5}) {
            const auto ramp = [&](const Vec3d& p) { return 0.5 - (dot(way, p) - at); };
            set_scalars(solver, ramp, [&](const Vec3d& p) { return ambient - 10 * ramp(p); });
            bool is_inside = false;  // the level 1/2 runs through the domain
            for_cells(Box3i{{}, solver.domain().cells}, [&](const Vec3i& c) {
                is_inside |= ramp(solver.domain().center_of(c)) < 0.5;
            });
            const double front = measure_front(solver, way, true, 0.5);
            if (!is_inside) continue;
            if (std::isnan(front)) {
                for_cells(Box3i{{}, solver.domain().cells}, [&](const Vec3i& c) {
                    EXPECT_LE(ramp(solver.domain().center_of(c)), 0.5 + 1e-6);
                });
                continue;
            }
            EXPECT_NEAR(front, at, 1e-5);
            EXPECT_NEAR(measure_front(solver, way, false, -5), at, 1e-5);
        }
    }
    EXPECT_TRUE(std::isnan(measure_front(solver, {1, 0, 0}, true, 99)));
}

TEST(Plume, FluxesOfAGaussianAreTheIntegrals) {
    for (const double sign : {1.0, -1.0}) {
        FluidWorld world = still_world();
        world.gravity = {0, 0, -9.8 * sign};
        SmokeParams params = unit_domain(32, false);
        params.thermal_expansion = 0.004;
        SmokeSolver solver(params, world);
        const double width = 0.1, top_speed = 0.6, heat = 20;
        const auto bell = [&](const Vec3d& p) {
            const double x = p.x - 0.5, y = p.y - 0.5;
            return std::exp(-(x * x + y * y) / (width * width));
        };
        set_velocity(solver,
                     [&](const Vec3d& p) { return Vec3d(0, 0, sign * top_speed * bell(p)); });
        set_scalars(solver, nullptr,
                    [&](const Vec3d& p) { return params.ambient_temperature + heat * bell(p); });
        const double area = pi * width * width, g = 9.8 * 0.004 * heat;
        // Small cut-offs leave out what the floor of the temperature does, 1e-4 K.
        const PlumeSample s = measure_plume(solver, 0.41, 1e-5);
        EXPECT_NEAR(s.volume_flux, area * top_speed, 1e-3 * area * top_speed);
        EXPECT_NEAR(s.momentum_flux, area * top_speed * top_speed / 2, 1e-5);
        EXPECT_NEAR(s.buoyancy_flux, area * top_speed * g / 2, 1e-5);
        const TopHat t = top_hat(s, false);
        EXPECT_NEAR(t.radius, std::sqrt(2.0) * width, 1e-3 * width);
        EXPECT_NEAR(t.speed, top_speed / 2, 1e-3 * top_speed);
        EXPECT_NEAR(t.gravity, g / 2, 1e-3 * g);
    }
    EXPECT_THROW(up_direction({0, 1, -9}), Error);
    EXPECT_THROW(up_direction({0, 0, 0}), Error);
    EXPECT_NEAR(top_hat({6, 12, 3}, true).radius, 1.5, 1e-12) << "Q = 2 b w";
}

}  // namespace
}  // namespace gischt
