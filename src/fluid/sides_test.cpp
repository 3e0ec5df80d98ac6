// SPDX-License-Identifier: Apache-2.0
#include "fluid/sides.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fluid/block.h"
#include "fluid/smoke.h"

namespace gischt {
namespace {

SideParams moving(const Keyed<Vec3d>& velocity, SideProfile profile = SideProfile::Uniform) {
    SideParams s;
    s.velocity = velocity;
    s.profile = profile;
    return s;
}

SideParams warm(double kelvin) {
    SideParams s;
    s.temperature = kelvin;
    return s;
}

SmokeParams box_2d(int resolution, double width, double height) {
    SmokeParams p;
    p.domain.resolution = resolution;
    p.domain.max = {width, height, 0};
    p.domain.set_all_sides(SideKind::NoSlip);
    p.pressure_tolerance = 1e-6;
    return p;
}

FluidWorld weightless() {
    FluidWorld world;
    world.gravity = {};
    return world;
}

// --- Ghosts.

TEST(SideValues, ContinueALinearProfileThroughMovingWalls) {
    // u = 2 at the lower y side and 5 at the upper one, -1 and 4 for z: what is linear inside goes
    // on linearly outside, corners and regions that turn back twice included.
    DomainParams params;
    params.resolution = 24;
    params.max = {1, 0.25, 1};
    params.set_all_sides(SideKind::NoSlip);
    params.x_min = params.x_max = SideKind::Periodic;
    params.z_min = params.z_max = SideKind::FreeSlip;
    params.sides.y_min = moving(Vec3d(2, 0, 0));
    params.sides.y_max = moving(Vec3d(5, 0, 0));
    Domain domain(params);
    domain.held = side_values_at(domain, 0, 300);
    const auto exact = [&](const Vec3i& f) { return 2 + 3 * (f.y + 0.5) / domain.cells.y; };
    FaceField u(domain.map);
    const Box3i all = domain.faces_of(Box3i{{}, domain.cells}, 0);
    for_cells(all, [&](const Vec3i& f) { u.ref(0, f) = static_cast<float>(exact(f)); });
    const Lattice lattice{{{-2, -8, -3}, {27, 15, 27}}};
    std::vector<float> values(lattice.count());
    gather_block_faces(u, 0, lattice, domain.velocity_borders(0), values.data());
    add_side_velocity(domain, 0, lattice, values.data());
    for_cells(lattice.region, [&](const Vec3i& f) {
        ASSERT_NEAR(values[static_cast<std::size_t>(lattice.index(f))], exact(f), 1e-5);
    });
}

// --- Steady flows.

// The solver after `count` steps of dt.
void run(SmokeSolver& solver, int count, double dt) {
    Job job;
    for (int s = 0; s < count; ++s) solver.step(dt, job);
}

TEST(WindTunnel, AMovingWallDragsTheFluidAlongLinearly) {
    SmokeParams p = box_2d(32, 1, 0.5);
    p.domain.x_min = p.domain.x_max = SideKind::Periodic;
    p.domain.sides.y_max = moving(Vec3d(1, 0, 0));
    p.viscosity = 0.1;
    SmokeSolver solver(p, weightless());
    run(solver, 100, 0.2);  // ten times L^2 / nu
    const Domain& d = solver.domain();
    for (int j = 0; j < d.cells.y; ++j) {
        EXPECT_NEAR(solver.state().velocity.get(0, {7, j, 0}), (j + 0.5) / d.cells.y, 1e-4);
    }
}

TEST(WindTunnel, AForceBetweenWallsMakesAParabola) {
    SmokeParams p = box_2d(32, 1, 0.5);
    p.domain.x_min = p.domain.x_max = SideKind::Periodic;
    p.viscosity = 0.1;
    p.body_acceleration = Vec3d(0.4, 0, 0);
    SmokeSolver solver(p, weightless());
    run(solver, 100, 0.2);
    const Domain& d = solver.domain();
    const double height = 0.5;
    for (int j = 0; j < d.cells.y; ++j) {
        // The wall holds the profile's mean over a cell: a constant a h^2 / (8 nu) above the
        // parabola.
        const double y = (j + 0.5) * d.h;
        const double exact = 0.4 / (2 * 0.1) * (y * (height - y) + 0.25 * d.h * d.h);
        EXPECT_NEAR(solver.state().velocity.get(0, {3, j, 0}), exact, 1e-4);
    }
}

TEST(WindTunnel, AParabolaFlowsThroughUnchanged) {
    // Poiseuille flow: pressure falls by 8 rho nu U / H^2 per metre.
    SmokeParams p = box_2d(60, 1.5, 0.5);
    p.domain.x_min = SideKind::Inflow;
    p.domain.x_max = SideKind::Open;
    p.domain.sides.x_min = moving(Vec3d(1.2, 0, 0), SideProfile::Parabolic);
    p.viscosity = 0.05;
    SmokeSolver solver(p, weightless());
    run(solver, 150, 0.03);
    // The fluid slips by dt times the pressure's gradient after each step.
    run(solver, 200, 0.002);
    const Domain& d = solver.domain();
    const SmokeState& s = solver.state();
    for (const int i : {0, 20, 40, 60}) {
        for (int j = 0; j < d.cells.y; ++j) {
            const double y = (j + 0.5) / d.cells.y;
            EXPECT_NEAR(s.velocity.get(0, {i, j, 0}), 1.2 * 4 * y * (1 - y), 0.012) << i;
        }
    }
    const auto pressure = [&](int i) {
        return s.potential.get({i, 10, 0}) * d.h / s.potential_dt;  // over rho
    };
    const double slope = (pressure(45) - pressure(15)) / (30 * d.h);
    EXPECT_NEAR(slope, -8 * 0.05 * 1.2 / 0.25, 0.02 * 8 * 0.05 * 1.2 / 0.25);
}

TEST(WindTunnel, AParabolaInThreeDimensionsIsAProduct) {
    DomainParams params;
    params.resolution = 16;
    params.set_all_sides(SideKind::NoSlip);
    params.x_min = SideKind::Open;
    params.x_max = SideKind::Inflow;
    params.z_max = SideKind::FreeSlip;
    params.sides.x_max = moving(Vec3d(-2, 0, 0), SideProfile::Parabolic);
    Domain domain(params);
    domain.held = side_values_at(domain, 0, 300);
    FaceField u(domain.map);
    close_sides(domain, u);
    for (const Vec3i f : {Vec3i(16, 0, 0), Vec3i(16, 5, 9), Vec3i(16, 15, 15)}) {
        // A free-slip side is the middle of a channel of twice the height.
        const double y = (f.y + 0.5) / 16, z = (f.z + 0.5) / 16;
        EXPECT_NEAR(u.get(0, f), -2 * 4 * y * (1 - y) * z * (2 - z), 1e-5);
    }
}

TEST(WindTunnel, WhatFlowsInFlowsOut) {
    // A keyframed inflow and an outflow beside it: the open side passes the same volume.
    SmokeParams p;
    p.domain.resolution = 24;
    p.domain.set_all_sides(SideKind::FreeSlip);
    p.domain.x_min = SideKind::Inflow;
    p.domain.z_max = SideKind::Open;
    p.domain.sides.x_min = moving({{0, 0.5}, {Vec3d(0, 0, 0), Vec3d(0.8, 0.3, 0)}});
    p.pressure_tolerance = 1e-6;
    SmokeSolver solver(p, weightless());
    Job job;
    for (int s = 1; s <= 8; ++s) {
        EXPECT_LT(solver.step(0.05, job).max_divergence_dt, 1e-5);
        double in = 0, out = 0;
        for (int j = 0; j < 24; ++j) {
            for (int i = 0; i < 24; ++i) {
                in += solver.state().velocity.get(0, {0, i, j});
                out += solver.state().velocity.get(2, {i, j, 24});
            }
        }
        EXPECT_NEAR(in / (24 * 24), 0.8 * 0.05 * s / 0.5, 1e-6);
        EXPECT_NEAR(out / in, 1, 1e-4);
    }
}

TEST(WindTunnel, AnInflowBringsSmokeAndHeat) {
    // Uniform flow carries both in: U t of the box is full, the front as far.
    SmokeParams p = box_2d(64, 1, 0.25);
    p.domain.set_all_sides(SideKind::FreeSlip);
    p.domain.x_min = SideKind::Inflow;
    p.domain.x_max = SideKind::Open;
    p.domain.sides.x_min = moving(Vec3d(1, 0, 0));
    p.domain.sides.x_min->density = 0.7;
    p.domain.sides.x_min->temperature = 350.0;
    p.initial_velocity = {1, 0, 0};
    SmokeSolver solver(p, weightless());
    run(solver, 30, 1.0 / 60);
    const Domain& d = solver.domain();
    const double area = solver.density_integral() / d.h;
    // The interpolation takes the smoke to be at the centre of the cell beyond the side.
    EXPECT_NEAR(area, 0.7 * 0.25 * 0.5, 0.7 * 0.25 * d.h);
    EXPECT_NEAR(solver.state().density.values.get({16, 8, 0}), 0.7, 1e-3);
    EXPECT_NEAR(solver.state().temperature.values.get({16, 8, 0}), 350 - p.ambient_temperature,
                0.1);
    EXPECT_NEAR(solver.state().density.values.get({50, 8, 0}), 0, 1e-3);
}

// --- Heat.

TEST(WindTunnel, HeatPassesBetweenWallsLinearly) {
    SmokeParams p = box_2d(32, 1, 0.5);
    p.domain.sides.y_min = warm(320);
    p.domain.sides.y_max = warm(280);
    p.thermal_diffusivity = 0.1;
    SmokeSolver solver(p, weightless());
    run(solver, 100, 0.2);
    const Domain& d = solver.domain();
    for (int j = 0; j < d.cells.y; ++j) {
        const double exact = 320 - 40 * (j + 0.5) / d.cells.y;
        EXPECT_NEAR(solver.state().temperature.values.get({9, j, 0}) + p.ambient_temperature, exact,
                    0.01);
    }
}

// Largest speed after some steps of a closed tank that is colder below, along gravity.
double speed_in_stratified_tank(double degrees) {
    const double angle = degrees * pi / 180;
    const Vec3d up{-std::sin(angle), std::cos(angle), 0};
    SmokeParams p = box_2d(48, 1, 1);
    FluidWorld world;
    world.gravity = -9.81 * up;
    SmokeSolver solver(p, world);
    Job job;
    solver.fill({.velocity = nullptr,
                 .density = nullptr,
                 .temperature = [&](const Vec3d& at) { return 300 + 20 * dot(at, up); }},
                job);
    double top = 0;
    for (int s = 0; s < 10; ++s) top = std::max(top, solver.step(0.01, job).max_speed);
    return top;
}

TEST(Statics, AStratifiedTankStaysAtRest) {
    // Its weight would move it by 0.06 m/s per step.
    EXPECT_LT(speed_in_stratified_tank(0), 1e-5);
}

TEST(Statics, AStratifiedTankStaysAtRestTilted) {
    EXPECT_LT(speed_in_stratified_tank(30), 1e-5);
}

// --- What cannot be.

struct BadSide {
    const char* key;
    std::function<void(DomainParams&)> make;
};

TEST(SideParams, RefuseWhatASideCannotHold) {
    const std::vector<BadSide> cases{
        {"x_min.velocity", [](DomainParams& p) { p.sides.x_min = moving(Vec3d(1, 0, 0)); }},
        {"y_max.velocity",
         [](DomainParams& p) {
             p.y_max = SideKind::NoSlip;
             p.sides.y_max = moving(Vec3d(1, 0.1, 0));
         }},
        {"z_min.velocity",
         [](DomainParams& p) {
             p.z_min = SideKind::FreeSlip;
             p.sides.z_min = moving(Vec3d(1, 0, 0));
         }},
        {"x_max.velocity",
         [](DomainParams& p) {
             p.x_max = SideKind::Inflow;
             p.sides.x_max = moving(Vec3d(1, 0, 0));
         }},
        {"x_max", [](DomainParams& p) { p.x_max = SideKind::Inflow; }},
        {"x_min.velocity",
         [](DomainParams& p) {
             p.x_min = SideKind::Inflow;
             p.sides.x_min = moving(Vec3d(1, 0.5, 0), SideProfile::Parabolic);
         }},
        {"y_min.density", [](DomainParams& p) { p.sides.y_min.emplace().density = 1.0; }},
        {"y_min.temperature",
         [](DomainParams& p) {
             p.y_min = p.y_max = SideKind::Periodic;
             p.sides.y_min = warm(300);
         }},
        {"domain",
         [](DomainParams& p) {
             p.set_all_sides(SideKind::NoSlip);
             p.x_min = SideKind::Inflow;
             p.sides.x_min = moving(Vec3d(1, 0, 0));
         }},
        {"z_max",
         [](DomainParams& p) {
             p.max.z = p.min.z;
             p.z_max = SideKind::NoSlip;
             p.sides.z_max = warm(300);
         }},
        {"x_min",
         [](DomainParams& p) {
             p.x_min = SideKind::NoSlip;
             p.sides.x_min = warm(-3);
         }},
    };
    for (const BadSide& bad : cases) {
        DomainParams params;
        bad.make(params);
        try {
            const Domain domain(params);
            ADD_FAILURE() << bad.key;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(bad.key), std::string::npos) << e.what();
        }
    }
}

}  // namespace
}  // namespace gischt
