// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "fluid/smoke_frame.h"
#include "schema/toml.h"

namespace gischt {
namespace {

SmokeParams plume(int resolution) {
    SmokeParams params;
    params.domain.resolution = resolution;
    params.domain.max = {0.6, 0.6, 1};
    params.domain.z_min = SideKind::NoSlip;
    EmitterParams e;
    e.position = Vec3d(0.3, 0.3, 0.15);
    e.radius = 0.1;
    e.density = Keyed<double>(1);
    e.temperature = Keyed<double>(450);
    e.noise.amplitude = 0.7;
    e.noise.scale = 0.05;
    params.sources = {e};
    params.vorticity_confinement = 4.0;
    params.temperature_half_life = 1.0;
    return params;
}

SmokeParams precise_plume(int resolution) {
    SmokeParams params = plume(resolution);
    params.accuracy = Accuracy::High;
    params.density_advection = AdvectionScheme::Conservative;
    params.thermal_diffusivity = 1e-3;
    params.viscosity = 1e-3;
    return params;
}

FluidWorld ball() {
    FluidWorld world;
    SolidParams s;
    s.position = Keyed<Vec3d>({0, 1}, {Vec3d(0.3, 0.3, 0.5), Vec3d(0.4, 0.3, 0.5)});
    s.radius = 0.1;
    world.solids = {s};
    return world;
}

void expect_same_bits(const SmokeState& a, const SmokeState& b) {
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.steps, b.steps);
    for (int axis = 0; axis < a.velocity.axes(); ++axis) {
        EXPECT_EQ(a.velocity[axis].values(), b.velocity[axis].values());
    }
    EXPECT_EQ(a.potential.values(), b.potential.values());
    EXPECT_EQ(a.density.values.values(), b.density.values.values());
    EXPECT_EQ(a.temperature.values.values(), b.temperature.values.values());
}

std::filesystem::path scratch_file(const char* name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

TEST(SmokeSource, SameBitsOnOneAndTwoThreads) {
    Job job;
    for (const SmokeParams& params : {plume(40), precise_plume(32)}) {
        SmokeSource one(params, ball()), two(params, ball());
        {
            const ThreadLimit limit(1);
            one.frame(4, job);
        }
        const ThreadLimit limit(2);
        two.frame(4, job);
        EXPECT_GT(one.statistics().max_speed, 0.3);
        expect_same_bits(one.solver().state(), two.solver().state());
    }
}

TEST(SmokeSource, ResumesWithTheSameBits) {
    const auto path = scratch_file("gischt_smoke.state");
    Job job;
    for (const SmokeParams& params : {plume(40), precise_plume(32)}) {
        SmokeSource whole(params, ball());
        whole.frame(2, job);
        whole.save_state(path);
        whole.frame(5, job);

        SmokeSource resumed(params, ball());
        resumed.load_state(path);
        EXPECT_EQ(resumed.last_frame(), 2);
        resumed.frame(5, job);
        expect_same_bits(whole.solver().state(), resumed.solver().state());
        EXPECT_EQ(whole.statistics().pressure_iterations, resumed.statistics().pressure_iterations);
        std::filesystem::remove(path);
    }
}

TEST(SmokeSource, RefusesDamagedStatesAndKeepsItsOwn) {
    const auto path = scratch_file("gischt_damaged.state");
    Job job;
    SmokeSource source(plume(24), {});
    source.frame(1, job);
    source.save_state(path);
    EXPECT_THROW(SmokeSource(plume(32), {}).load_state(path), Error);
    const auto size = std::filesystem::file_size(path);
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(size / 2));
        file.put('\x55');
    }
    const SmokeState before = source.solver().state();
    EXPECT_THROW(source.load_state(path), Error);
    std::filesystem::resize_file(path, size / 2);
    EXPECT_THROW(source.load_state(path), Error);
    std::filesystem::resize_file(path, 0);
    EXPECT_THROW(source.load_state(path), Error);
    EXPECT_THROW(source.load_state(scratch_file("gischt_none.state")), Error);
    expect_same_bits(before, source.solver().state());
    EXPECT_THROW(source.save_state("/nonexistent/folder/x.state"), Error);
    std::filesystem::remove(path);
}

TEST(SmokeSource, GivesFramesOnTimeAndInOrder) {
    Job job;
    FluidWorld world;
    world.fps = 30;
    SmokeParams params = plume(24);
    params.cfl = 0.5;
    SmokeSource source(params, world);
    for (const int n : {1, 2, 7}) {
        const Frame f = source.frame(n, job);
        EXPECT_EQ(f.number, n);
        EXPECT_NEAR(f.time, n / 30.0, 1e-12);
        EXPECT_EQ(f.dt, 1 / 30.0);
    }
    EXPECT_GT(source.statistics().steps, 1);
    EXPECT_EQ(source.frame(7, job).number, 7);
    EXPECT_THROW(source.frame(3, job), Error);
}

TEST(SmokeSource, WarnsWhenStepsAreTooFew) {
    SmokeParams params = plume(24);
    params.max_substeps = 1;
    params.sources[0].velocity = Keyed<Vec3d>(Vec3d(0, 0, 20));
    params.sources[0].mode = EmitterMode::Set;
    SmokeSource source(params, {});
    int warnings = 0;
    Job job;
    job.on_message = [&](Job::Level level, std::string_view) {
        warnings += level == Job::Level::Warning;
    };
    source.frame(3, job);
    EXPECT_GE(warnings, 2);
    EXPECT_EQ(source.statistics().steps, 1);
}

TEST(SmokeSource, GoesOnFromAStateAfterItWasCancelled) {
    const auto path = scratch_file("gischt_cancelled.state");
    SmokeSource source(plume(24), {});
    Job good;
    source.frame(1, good);
    source.save_state(path);
    Job stopped;
    stopped.cancel();
    try {
        source.frame(2, stopped);
        ADD_FAILURE() << "not cancelled";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Cancelled);
    }
    EXPECT_THROW(source.frame(2, good), Error);
    EXPECT_THROW(source.save_state(path), Error);
    source.load_state(path);
    EXPECT_EQ(source.frame(2, good).number, 2);
    std::filesystem::remove(path);
}

TEST(SmokeFrame, HoldsContentOnFewTiles) {
    Job job;
    SmokeParams params = plume(48);
    params.output.pressure = params.output.vorticity = true;
    SmokeSource source(params, ball());
    const Frame f = source.frame(6, job);
    const Field &density = *f.find("density"), &heat = *f.find("temperature"),
                &velocity = *f.find("velocity");
    EXPECT_LT(density.map().size(), source.solver().domain().map->size() / 3);
    EXPECT_GT(velocity.map().size(), density.map().size());
    EXPECT_NEAR(heat.background[0], 293.15, 1e-4);
    EXPECT_NEAR(density.cell_size(), 1.0 / 48, 1e-12);

    const SmokeState& state = source.solver().state();
    double mass = 0, most = 0;
    for (int t = 0; t < density.map().size(); ++t) {
        for (int i = 0; i < tile_values; ++i) mass += density.component[0].tile(t)[i];
    }
    for (int t = 0; t < heat.map().size(); ++t) {
        for (int i = 0; i < tile_values; ++i) {
            most = std::max(most, static_cast<double>(heat.component[0].tile(t)[i]));
        }
    }
    EXPECT_GT(most, 350);
    const double cell = density.cell_size();
    EXPECT_NEAR(1.2 * mass * cell * cell * cell, source.statistics().mass,
                1e-6 * source.statistics().mass);
    const Vec3i c{14, 14, 9};
    EXPECT_EQ(velocity.component[2].get(c),
              0.5f * (state.velocity.get(2, c) + state.velocity.get(2, c + Vec3i(0, 0, 1))));
    EXPECT_EQ(density.component[0].get(c), state.density.values.get(c));
    // No smoke inside the ball, which has come a quarter of 0.1 m far.
    EXPECT_EQ(density.sample({0.325, 0.3, 0.5}), 0);
    EXPECT_TRUE(f.find("pressure") && f.find("vorticity")->is_vector());
}

TEST(SmokeTable, ReadsAScene) {
    const Value scene = parse_toml(R"(
        density_half_life = 4
        vorticity_confinement = { t = [0, 1], v = [0, 5] }
        velocity_advection = "semi_lagrangian"
        [domain]
        resolution = 96
        max = [2, 2, 3]
        z_min = "no_slip"
        [[source]]
        shape = "box"
        position = [1, 1, 0.3]
        density = 1
        temperature = 500
        mode = "set"
        [source.noise]
        amplitude = 0.8
    )",
                                   "test.toml");
    const SmokeParams p = read(scene, smoke_table());
    EXPECT_EQ(p.domain.resolution, 96);
    EXPECT_EQ(p.domain.z_min, SideKind::NoSlip);
    EXPECT_EQ(p.domain.z_max, SideKind::Open);
    EXPECT_EQ(p.vorticity_confinement.at(0.5), 2.5);
    EXPECT_EQ(p.velocity_advection, AdvectionScheme::SemiLagrangian);
    ASSERT_EQ(p.sources.size(), 1u);
    EXPECT_EQ(p.sources[0].mode, EmitterMode::Set);
    EXPECT_EQ(p.sources[0].temperature->at(0), 500);
    EXPECT_FALSE(p.sources[0].velocity.has_value());
    EXPECT_EQ(p.sources[0].noise.amplitude, 0.8);
    EXPECT_THROW(read(parse_toml("cfl = -1", "t"), smoke_table()), Error);
    EXPECT_THROW(read(parse_toml("[[source]]\nradius = 1", "t"), smoke_table()), Error);
}

}  // namespace
}  // namespace gischt
