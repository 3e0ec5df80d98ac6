// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "fluid/probes/heat_flux.h"
#include "fluid/probes/sample.h"
#include "fluid/probes/test_smoke.h"
#include "fluid/smoke_source.h"

namespace gischt {
namespace {

TEST(Sample, OfLinearFieldsIsExactAlsoBesideWallsAndSolids) {
    for (const bool is_2d : {true, false}) {
        FluidWorld world = still_world();
        SolidParams ball;
        ball.position = Vec3d(0.52, 0.47, is_2d ? 0 : 0.5);
        ball.radius = 0.2;
        world.solids = {ball};
        SmokeSolver solver(unit_domain(20, is_2d), world);
        const Vec3d slope(2, -1, is_2d ? 0 : 0.5);
        const auto linear = [&](const Vec3d& p) { return 3 + dot(slope, p); };
        set_velocity(solver, [&](const Vec3d& p) {
            return Vec3d(linear(p), 2 * linear(p), is_2d ? 0 : -linear(p));
        });
        set_scalars(solver, linear, [&](const Vec3d& p) { return 300 + linear(p); });
        set_pressure(solver, linear);
        const double side = is_2d ? 0 : 0.5;
        // Faces on walls are closed: the velocity is asked for further in.
        for (const Vec3d& p : {Vec3d(0, 0.5, side), Vec3d(1, 1, side), Vec3d(0.01, 0.99, side),
                               Vec3d(0.32, 0.47, side), Vec3d(0.73, 0.47, side),
                               Vec3d(0.2, 0.3, 0.4 * side), Vec3d(0.85, 0.15, 1.9 * side)}) {
            const SmokeSample s = sample_smoke(solver, p);
            EXPECT_NEAR(s.pressure, linear(p), 1e-4);
            EXPECT_NEAR(s.density, linear(p), 1e-4);
            EXPECT_NEAR(s.temperature, 300 + linear(p), 1e-3);
            if (p.x < 0.1 || p.x > 0.9 || p.y > 0.9 || p.z > 0.9) continue;
            EXPECT_NEAR(s.velocity.x, linear(p), 1e-4);
            EXPECT_NEAR(s.velocity.y, 2 * linear(p), 1e-4);
        }
        const SmokeSample inside = sample_smoke(solver, {0.5, 0.5, side});
        EXPECT_TRUE(std::isnan(inside.velocity.x) && std::isnan(inside.pressure));
    }
}

TEST(Sample, GoesAroundPeriodicSides) {
    SmokeParams params = unit_domain(64, true, SideKind::Periodic);
    SmokeSolver solver(params, still_world());
    set_velocity(solver, [](const Vec3d& p) { return Vec3d(std::sin(2 * pi * p.x), 0, 0); });
    for (const double x : {0.0, 0.003, 0.995, 1.0}) {
        EXPECT_NEAR(sample_smoke(solver, {x, 0.999, 0}).velocity.x, std::sin(2 * pi * x), 2e-3);
    }
}

TEST(SideFlux, OfALinearTemperatureIsThatOfConduction) {
    for (const bool is_2d : {true, false}) {
        SmokeParams params = unit_domain(16, is_2d);
        params.domain.max.x = 2;
        params.thermal_diffusivity = 0.03;
        params.domain.resolution = 32;
        SmokeSolver solver(params, still_world());
        set_scalars(solver, nullptr, [](const Vec3d& p) { return 320 - 5 * p.x; });
        const SideFlux hot = measure_side_flux(solver, 0, 0, 320),
                       cold = measure_side_flux(solver, 0, 1, 310);
        EXPECT_NEAR(hot.total, 0.03 * 5, 1e-5);
        EXPECT_NEAR(cold.total, -0.03 * 5, 1e-5);
        EXPECT_NEAR(hot.area, 1, 1e-12);
        EXPECT_EQ(hot.local.size(), is_2d ? 16u : 256u);
        EXPECT_EQ(measure_side_flux(solver, 1, 0, std::nullopt).total, 0) << "insulated";
        HeatFluxProbe probe;
        probe.wall_temperature = 320;
        probe.delta_temperature = 10;
        probe.length = 2;
        const auto rows = measure_probe(probe, solver);
        ASSERT_EQ(rows.size(), 1u);
        EXPECT_NEAR(rows[0].back(), 1, 1e-4) << "Nusselt number of conduction";
    }
}

TEST(SideFlux, KnowsWhatTheDomainHolds) {
    SmokeParams params = unit_domain(16, true, SideKind::NoSlip);
    const double ambient = params.ambient_temperature;
    params.domain.sides.x_min.emplace();
    params.domain.sides.x_min->temperature = Keyed<double>(ambient + 10);
    params.domain.sides.x_max.emplace();
    params.domain.sides.x_max->temperature = Keyed<double>(ambient - 10);
    params.thermal_diffusivity = 0.02;
    SmokeSolver solver(params, still_world());
    set_scalars(solver, nullptr, [&](const Vec3d& p) { return ambient + 10 - 20 * p.x; });
    Job job;
    solver.step(0.1, job);  // a steady state
    EXPECT_NEAR(measure_side_flux(solver, 0, 0, std::nullopt).total, 0.02 * 20, 1e-3);
    EXPECT_NEAR(measure_side_flux(solver, 0, 1, std::nullopt).total, -0.02 * 20, 1e-3);
    EXPECT_EQ(measure_side_flux(solver, 1, 0, std::nullopt).total, 0);
}

std::vector<ProbeParams> one_of_each() {
    PointProbe point;
    point.points = {{0.5, 0.5, 0.2}, {0.1, 0.9, 0.3}};
    LineProbe line;
    line.from = {0.1, 0.1, 0.1};
    line.to = {0.9, 0.1, 0.1};
    line.count = 5;
    HeatFluxProbe local, nusselt;
    local.local = true;
    nusselt.length = nusselt.delta_temperature = 1;
    ForceProbe force, coefficients;
    force.solid = coefficients.solid = "ball";
    coefficients.reference_speed = coefficients.reference_area = 1;
    PlumeProbe plume;
    plume.heights = {0.3, 0.6, 0.8};
    return {point,        line,        EnergyProbe{}, HeatFluxProbe{}, local,  force,
            coefficients, MassProbe{}, FrontProbe{},  plume,           nusselt};
}

TEST(Probe, RowsHaveTheirColumns) {
    for (const bool is_2d : {true, false}) {
        FluidWorld world;
        world.gravity = is_2d ? Vec3d(0, -9.8, 0) : Vec3d(0, 0, -9.8);
        SolidParams ball;
        ball.name = "ball";
        ball.radius = 0.1;
        ball.position = Vec3d(0.3, 0.6, is_2d ? 0 : 0.5);
        world.solids = {ball};
        SmokeSolver solver(unit_domain(16, is_2d), world);
        for (const ProbeParams& probe : one_of_each()) {
            const auto columns = probe_columns(probe, is_2d);
            const auto rows = measure_probe(probe, solver);
            ASSERT_FALSE(rows.empty());
            EXPECT_EQ(columns[0], "time [s]");
            for (const ProbeRow& row : rows) EXPECT_EQ(row.size(), columns.size()) << columns[1];
            for (const std::string& c : columns) EXPECT_NE(c.find(" ["), std::string::npos) << c;
        }
        EXPECT_NO_THROW(Probes(one_of_each(), solver));
        ForceProbe lost;
        lost.solid = "bal";
        EXPECT_THROW(Probes({lost}, solver), Error);
    }
}

TEST(Probe, RefusesWhatTheFluidDoesNotReach) {
    DomainParams domain;
    domain.max = {1, 2, 0};
    const Vec3d down(0, -9.8, 0);
    PointProbe point;
    point.points = {{0.5, 2.1, 0}};
    EXPECT_THROW(check_probe(point, domain, down), Error);
    point.points = {{0.5, 2.0, 77}};
    EXPECT_NO_THROW(check_probe(point, domain, down)) << "z does not count in 2-D";
    LineProbe line;
    line.to = {1.5, 0, 0};
    EXPECT_THROW(check_probe(line, domain, down), Error);
    HeatFluxProbe flux;
    flux.side = DomainSide::ZMax;
    EXPECT_THROW(check_probe(flux, domain, down), Error);
    flux.side = DomainSide::XMin;
    domain.x_min = domain.x_max = SideKind::Periodic;
    EXPECT_THROW(check_probe(flux, domain, down), Error);
    PlumeProbe plume;
    plume.heights = {1.9};
    EXPECT_NO_THROW(check_probe(plume, domain, down));
    EXPECT_THROW(check_probe(plume, domain, {0, 0, -9.8}), Error);
    EXPECT_THROW(check_probe(plume, domain, {1, -9, 0}), Error);
    plume.heights = {2.1};
    EXPECT_THROW(check_probe(plume, domain, down), Error);
}

TEST(Probe, MeasuresEveryFrameOrStepWithinItsTime) {
    SmokeParams params = unit_domain(16, true);
    params.min_substeps = 3;
    FluidWorld world = still_world();
    world.fps = 10;
    EnergyProbe frames, steps, late;
    steps.every = ProbeEvery::Step;
    late.start = 0.2;
    late.stop = 0.3;
    SmokeSource source(params, world);
    ASSERT_TRUE(source.set_probes({frames, steps, late}));
    Job job;
    source.frame(2, job);
    auto rows = source.take_probe_rows();
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].size(), 3u) << "the beginning and two frames";
    EXPECT_EQ(rows[1].size(), 7u);
    EXPECT_EQ(rows[2].size(), 1u);
    EXPECT_EQ(rows[0][0][0], 0);
    EXPECT_NEAR(rows[0][2][0], 0.2, 1e-12);
    EXPECT_NEAR(rows[1][1][0], 0.1 / 3, 1e-12);
    source.frame(5, job);
    rows = source.take_probe_rows();
    EXPECT_EQ(rows[0].size(), 3u);
    EXPECT_EQ(rows[2].size(), 1u);
}

}  // namespace
}  // namespace gischt
