// SPDX-License-Identifier: Apache-2.0
#include "fluid/ledger.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fluid/probes/test_smoke.h"

namespace gischt {
namespace {

double sum_of(const ScalarLedger& l) {
    return l.before + l.sources + l.inflow - l.outflow - l.decayed + l.diffused + l.numerical;
}

// The value of a smooth blob of the given radius.
double blob(const Vec3d& p, const Vec3d& center, double radius) {
    Vec3d d = p - center;
    return std::exp(-dot(d, d) / (radius * radius));
}

TEST(Ledger, AddsUpInAPlumeWithEverything) {
    SmokeParams params = unit_domain(24, false, SideKind::Open);
    params.domain.z_min = SideKind::FreeSlip;
    params.density_half_life = 1;
    params.temperature_half_life = 0.5;
    params.smoke_diffusivity = 1e-3;
    params.thermal_diffusivity = 2e-3;
    EmitterParams source;
    source.position = Vec3d(0.5, 0.5, 0.15);
    source.radius = 0.12;
    source.density = Keyed<double>(1);
    source.temperature = Keyed<double>(500);
    params.sources = {source};
    FluidWorld world;
    SolidParams ball;
    ball.radius = 0.12;
    ball.position = Keyed<Vec3d>({0, 2}, {{0.6, 0.5, 0.6}, {0.4, 0.5, 0.6}});
    world.solids = {ball};
    SmokeSolver solver(params, world);
    solver.restart_ledger();
    Job job;
    for (int i = 0; i < 40; ++i) solver.step(0.04, job);
    const ScalarLedger &mass = solver.ledger().density(), &heat = solver.ledger().heat();
    EXPECT_NEAR(mass.after, solver.density_integral(), 1e-6 * mass.after);
    for (const ScalarLedger& l : {mass, heat}) {
        EXPECT_NEAR(sum_of(l), l.after, 1e-6 * l.after);
        EXPECT_EQ(l.before, 0);
        EXPECT_GT(l.sources, 0);
        EXPECT_GT(l.outflow, 0);
        EXPECT_GT(l.decayed, 0);
        EXPECT_LT(l.diffused, 0);
    }
    fmt::print(
        "  smoke: sources {:.4f} out {:.4f} decayed {:.4f} diffused {:.5f} numerical {:.5f} "
        "after {:.4f}\n",
        mass.sources, mass.outflow, mass.decayed, mass.diffused, mass.numerical, mass.after);
}

TEST(Ledger, KnowsDecayFromLoss) {
    SmokeParams params = unit_domain(16, true);
    params.density_half_life = 0.5;
    SmokeSolver solver(params, still_world());
    set_scalars(
        solver, [](const Vec3d&) { return 0.8; }, nullptr);
    solver.restart_ledger();
    Job job;
    for (int i = 0; i < 10; ++i) solver.step(0.1, job);
    const ScalarLedger& l = solver.ledger().density();
    EXPECT_NEAR(l.after, l.before / 4, 1e-6 * l.before);
    EXPECT_NEAR(l.decayed, 0.75 * l.before, 1e-5 * l.before);
    EXPECT_NEAR(l.numerical, 0, 1e-5 * l.before);
    EXPECT_EQ(l.outflow, 0);
}

TEST(Ledger, CountsWhatASourceGives) {
    SmokeParams params = unit_domain(32, true);
    EmitterParams source;
    source.kind = EmitterKind::Box;
    source.position = Vec3d(0.5, 0.5, 0);
    source.size = Vec3d(0.5, 0.25, 1);
    source.density = Keyed<double>(1);
    source.mode = EmitterMode::Set;
    params.sources = {source};
    SmokeSolver solver(params, still_world());
    Job job;
    for (int i = 0; i < 5; ++i) solver.step(0.05, job);
    const ScalarLedger& l = solver.ledger().density();
    EXPECT_GT(l.sources, 0);
    EXPECT_NEAR(l.sources, l.after, 1e-6 * l.after) << "air at rest loses nothing";
    EXPECT_NEAR(l.numerical, 0, 1e-6 * l.after);
}

TEST(Ledger, SeesABlobLeave) {
    for (const double cfl : {0.5, 2.5}) {
        SmokeParams params = unit_domain(64, true, SideKind::Open);
        // MacCormack's correction looks beyond the side and holds smoke back there.
        params.density_advection = AdvectionScheme::SemiLagrangian;
        SmokeSolver solver(params, still_world());
        set_velocity(solver, [](const Vec3d&) { return Vec3d(1, 0.2, 0); });
        set_scalars(
            solver,
            [](const Vec3d& p) {
                return blob(p, {0.6, 0.5, 0}, 0.12);
            },
            nullptr);
        solver.restart_ledger();
        const int steps = static_cast<int>(std::lround(0.9 * 64 / cfl));
        Job job;
        for (int i = 0; i < steps; ++i) solver.step(0.9 / steps, job);
        const ScalarLedger& l = solver.ledger().density();
        fmt::print("  cfl {}: before {:.5f} out {:.5f} numerical {:+.5f} after {:.5f}\n", cfl,
                   l.before, l.outflow, l.numerical, l.after);
        EXPECT_LT(l.after, 0.01 * l.before);
        EXPECT_NEAR(l.outflow, l.before, 0.03 * l.before);
        EXPECT_NEAR(sum_of(l), l.after, 1e-6 * l.before);
    }
}

TEST(Ledger, CountsWhatDiffusesThroughOpenSides) {
    SmokeParams params = unit_domain(32, true, SideKind::Open);
    params.smoke_diffusivity = 0.01;
    SmokeSolver solver(params, still_world());
    set_scalars(
        solver, [](const Vec3d&) { return 1.0; }, nullptr);
    solver.restart_ledger();
    Job job;
    for (int i = 0; i < 20; ++i) solver.step(0.1, job);
    const ScalarLedger& l = solver.ledger().density();
    EXPECT_LT(l.diffused, -0.3 * l.before);
    // The solution of each step is good to 1e-5 of its right-hand side.
    EXPECT_NEAR(l.numerical, 0, 20 * 1e-5 * l.before);
}

TEST(Ledger, CountsWhatFlowsIn) {
    SmokeParams params = unit_domain(32, true);
    params.domain.x_min = SideKind::Inflow;
    params.domain.x_max = SideKind::Open;
    params.domain.sides.x_min.emplace();
    params.domain.sides.x_min->velocity = Keyed<Vec3d>(Vec3d(1, 0, 0));
    params.domain.sides.x_min->density = Keyed<double>(0.5);
    params.density_advection = AdvectionScheme::SemiLagrangian;
    SmokeSolver solver(params, still_world());
    set_velocity(solver, [](const Vec3d&) { return Vec3d(1, 0, 0); });
    solver.restart_ledger();
    Job job;
    for (int i = 0; i < 40; ++i) solver.step(0.05, job);
    const ScalarLedger& l = solver.ledger().density();
    const double layer = 1.0 / 32;  // of one cell's thickness
    EXPECT_NEAR(l.inflow, 0.5 * 1 * 2 * layer, 0.02 * layer);
    EXPECT_NEAR(l.after, 0.5 * layer, 0.01 * layer) << "two seconds fill the box";
    EXPECT_NEAR(l.outflow, 0.5 * layer, 0.05 * layer);
    EXPECT_NEAR(sum_of(l), l.after, 1e-6 * l.after);
}

TEST(Ledger, CountsWhatHeldWallsConduct) {
    SmokeParams params = unit_domain(32, true, SideKind::NoSlip);
    params.domain.sides.x_min.emplace();
    params.domain.sides.x_min->temperature = Keyed<double>(params.ambient_temperature + 10);
    params.thermal_diffusivity = 0.01;
    SmokeSolver solver(params, still_world());
    solver.restart_ledger();
    Job job;
    for (int i = 0; i < 20; ++i) solver.step(0.1, job);
    const ScalarLedger& l = solver.ledger().heat();
    EXPECT_GT(l.diffused, 0);
    EXPECT_NEAR(l.diffused, l.after, 1e-3 * l.after) << "all heat comes through the wall";
    EXPECT_NEAR(l.numerical, 0, 1e-3 * l.after);
}

}  // namespace
}  // namespace gischt
