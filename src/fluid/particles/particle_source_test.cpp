// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/particle_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/parallel.h"
#include "base/units.h"
#include "schema/toml.h"

namespace gischt {
namespace {

// A spray with all that moves particles.
ParticleParams spray() {
    ParticleParams p;
    p.domain.resolution = 32;
    SpoutParams s;
    s.position = Vec3d(0, 0, 0.2);
    s.rate = Keyed<double>({0, 0.2}, {5000, 20000});
    s.cone_degrees = 15;
    s.speed = 5;
    s.life = 0.4;
    s.life_spread = 0.5;
    p.sources = {s, s};
    p.sources[1].kind = SpoutKind::Ball;
    p.motion.quadratic_drag = 0.2;
    p.air.turbulence.speed = 1;
    p.air.vortices.resize(1);
    p.motion.attractors.resize(1);
    p.look.opacity = Keyed<double>({0, 1}, {1, 0});
    p.look.temperature = Keyed<double>(900);
    return p;
}

FluidWorld with_ground() {
    FluidWorld world;
    world.solids.resize(1);
    world.solids[0].kind = SolidKind::Plane;
    return world;
}

std::filesystem::path scratch(const char* name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

void expect_same(const Frame& a, const Frame& b) {
    EXPECT_EQ(a.particles, b.particles);
    ASSERT_EQ(a.fields.size(), b.fields.size());
    for (const auto& [name, field] : a.fields) {
        for (std::size_t c = 0; c < field.component.size(); ++c) {
            EXPECT_EQ(field.component[c].values(), b.find(name)->component[c].values()) << name;
        }
    }
}

TEST(ParticleSource, SameBitsOnOneAndTwoThreads) {
    const auto make = [](int threads) {
        const ThreadLimit limit(threads);
        Job job;
        return ParticleSource(spray(), with_ground()).frame(8, job);
    };
    const Frame one = make(1);
    EXPECT_GT(one.particles.at("particles").size(), 1000u);
    expect_same(one, make(2));
}

TEST(ParticleSource, ResumesWithTheSameBits) {
    const auto path = scratch("gischt_particles.state");
    Job job;
    ParticleSource whole(spray(), with_ground());
    whole.frame(4, job);
    whole.save_state(path);
    ParticleSource resumed(spray(), with_ground());
    resumed.load_state(path);
    EXPECT_EQ(resumed.last_frame(), 4);
    expect_same(whole.frame(9, job), resumed.frame(9, job));
}

TEST(ParticleSource, RefusesDamagedStatesAndStaysAsItWas) {
    const auto path = scratch("gischt_particles_bad.state");
    Job job;
    ParticleSource source(spray(), with_ground());
    source.frame(3, job);
    source.save_state(path);
    std::string bytes;
    {
        std::ifstream in(path, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto write = [&](const std::string& content) {
        std::ofstream(path, std::ios::binary).write(content.data(), std::ssize(content));
    };
    for (const std::size_t cut : {std::size_t{0}, std::size_t{25}, bytes.size() - 1}) {
        write(bytes.substr(0, cut));
        EXPECT_THROW(source.load_state(path), Error) << cut;
    }
    for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 60) {
        std::string bad = bytes;
        bad[at] = static_cast<char>(bad[at] ^ 0x40);
        write(bad);
        EXPECT_THROW(source.load_state(path), Error) << at;
    }
    EXPECT_EQ(source.last_frame(), 3);
}

// Without drag the path of each particle is a parabola from its own birth, whatever the steps.
TEST(ParticleSource, BallisticMotionKnowsNoSteps) {
    const auto make = [](int substeps) {
        ParticleParams p = spray();
        p.motion = {};
        p.air = {};
        p.substeps = substeps;
        p.sources.resize(1);
        Job job;
        return ParticleSource(p, {}).frame(10, job).particles.at("particles");
    };
    const Particles one = make(1), many = make(13);
    ASSERT_EQ(one.id, many.id);
    EXPECT_GT(one.size(), 1000u);
    for (std::size_t i = 0; i < one.size(); ++i) {
        // Velocities are float: up to 130 roundings of 5 m/s during 0.4 s.
        EXPECT_LT(length(one.position[i] - many.position[i]), 1e-5);
        EXPECT_NEAR(one.age[i], many.age[i], 1e-5f);
    }
}

// Rate times life are alive, those of even births to within one.
TEST(ParticleSource, TheAgeEndsParticles) {
    ParticleParams p = spray();
    p.sources.resize(1);
    p.sources[0].rate = 10000;
    p.sources[0].life = 0.25;
    p.sources[0].life_spread = 0;
    p.motion.quadratic_drag = 0;
    Job job;
    const Frame frame = ParticleSource(p, {}).frame(24, job);
    EXPECT_NEAR(static_cast<double>(frame.particles.at("particles").size()), 2500, 2);
    for (const float age : frame.particles.at("particles").age) EXPECT_LT(age, 0.25f);
}

TEST(ParticleSource, CountsItsMassAndLooksItsAge) {
    ParticleParams p = spray();
    p.look.opacity = 0.5;
    p.look.size = Keyed<double>({0, 1}, {2, 2});
    p.density = 3;
    p.sources.resize(1);
    Job job;
    ParticleSource source(p, {});
    const Particles seen = source.frame(5, job).particles.at("particles");
    const double one = 1000 * 3 * 0.5 * 4 / 3 * pi * 8e-6;
    EXPECT_NEAR(source.statistics().mass, one * static_cast<double>(seen.size()),
                1e-5 * source.statistics().mass);
    EXPECT_EQ(seen.opacity.front(), 0.5f);
    EXPECT_EQ(seen.temperature.front(), 900);
    EXPECT_TRUE(seen.color.empty());
}

// Strong drag makes particles go with another fluid's wind.
TEST(ParticleSource, GoesWithAnotherFluid) {
    ParticleParams p = spray();
    p.motion = {};
    p.motion.linear_drag = 1000;
    p.air = {};
    p.gravity_scale = 0;
    p.sources[0].life = 10;
    p.sources[0].speed = 0.1;
    p.sources.resize(1);
    ParticleInputs inputs;
    inputs.flow = [](int number, Job&) {
        auto frame = std::make_shared<Frame>();
        Field& f = frame->fields["velocity"];
        for (int a = 0; a < 3; ++a) {
            f.component.emplace_back(TileMap::box(Vec3i(16)),
                                     a == 0 ? 0.1f * static_cast<float>(number) : 0.0f);
        }
        f.to_world = Transform::scale_translate(0.25, {-2, -2, -1});
        return frame;
    };
    Job job;
    const Frame frame = ParticleSource(p, {}, inputs).frame(12, job);
    const Particles& seen = frame.particles.at("particles");
    // The velocity grows evenly with time, 2.4 m/s^2; the lag is half of a step of 1/96 s.
    ASSERT_GT(seen.size(), 100u);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen.age[i] > 0.01f) {
            EXPECT_NEAR(seen.velocity[i].x, 1.2 - 2.4 / 192, 1e-3);
        }
    }
    const double t = static_cast<double>(seen.age[0]), end = 0.5;
    EXPECT_NEAR(seen.position[0].x, 1.2 * (end * end - (end - t) * (end - t)), 0.01);
}

TEST(ParticleSource, RefusesTooManyAndGoingBack) {
    ParticleParams p = spray();
    p.most_particles = 1000;
    Job job;
    EXPECT_THROW(ParticleSource(p, {}).frame(20, job), Error);
    ParticleSource source(spray(), {});
    source.frame(2, job);
    EXPECT_THROW(source.frame(1, job), Error);
    job.cancel();
    EXPECT_THROW(source.frame(3, job), Error);
}

TEST(ParticleTable, ReadsWhatItWrites) {
    const Value value = parse_toml(R"(
linear_drag = 2
wind = [1, 0, 0]
turbulence = { speed = 2, octaves = 3 }
over_life = { opacity = { t = [0, 1], v = [1, 0] }, color = [1, 0.5, 0] }
[[source]]
shape = "disc"
rate = { t = [0, 1], v = [0, 500] }
[[vortex]]
circulation = 3
[[attractor]]
strength = -1
)",
                                   "test");
    const ParticleParams p = read(value, particle_table());
    EXPECT_EQ(p.motion.linear_drag, 2);
    EXPECT_EQ(p.air.turbulence.octaves, 3);
    EXPECT_EQ(p.sources.at(0).kind, SpoutKind::Disc);
    EXPECT_EQ(p.air.vortices.at(0).circulation.at(0), 3);
    const Value again = to_value(p, particle_table());
    EXPECT_EQ(to_value(read(again, particle_table()), particle_table()), again);
    EXPECT_THROW(read(parse_toml("linear_drag = 1", "test"), particle_table()), Error);
}

}  // namespace
}  // namespace gischt
