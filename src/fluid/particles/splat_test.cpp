// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/splat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "base/units.h"

namespace gischt {
namespace {

const SplatLattice lattice{{20, 40, 17}, 0.1, {-1, 2, 3}};

// Particles in the lattice, up to its very sides, smaller and larger than cells.
Particles cloud_of(std::size_t count) {
    Particles p;
    p.opacity.push_back(1);
    p.color.push_back({});
    p.temperature.push_back(0);
    p.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t key = random_key(9, i);
        const auto u = [&](std::uint32_t d) { return random_uniform(key, d); };
        p.position[i] = lattice.origin + lattice.h * Vec3d(lattice.cells) * Vec3d(u(0), u(1), u(2));
        p.velocity[i] = {u(3), 2 * u(4), -u(5)};
        p.radius[i] = 0.01f + 0.3f * u(6) * u(6);
        p.opacity[i] = u(7);
        p.color[i] = {u(8), 0.5f, 0};
        p.temperature[i] = 300 + 1000 * u(9);
        p.life[i] = 1;
        p.id[i] = i;
    }
    return p;
}

double integral(const TileField<float>& f, const TileField<float>* times = nullptr) {
    double sum = 0;
    for (std::size_t i = 0; i < f.values().size(); ++i) {
        const double other = times ? static_cast<double>(times->values()[i]) : 1.0;
        sum += static_cast<double>(f.values()[i]) * other;
    }
    return sum * std::pow(lattice.h, 3);
}

// Content, momentum, heat and colour, to the rounding of float of sums of equal sign.
TEST(Splat, KeepsWhatTheParticlesHave) {
    const Particles p = cloud_of(3000);
    Frame frame;
    Job job;
    splat_particles(p, lattice, {2.5, 1.3}, frame, job);
    double content = 0, heat = 0, red = 0;
    Vec3d momentum;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double r = static_cast<double>(p.radius[i]);
        const double c = 2.5 * static_cast<double>(p.opacity[i]) * 4 / 3 * pi * r * r * r;
        content += c;
        momentum += c * Vec3d(p.velocity[i]);
        heat += c * static_cast<double>(p.temperature[i]);
        red += c * static_cast<double>(p.color[i].x);
    }
    const TileField<float>& density = frame.find("density")->component[0];
    EXPECT_NEAR(integral(density), content, 1e-6 * content);
    for (int a = 0; a < 3; ++a) {
        const auto& v = frame.find("velocity")->component[static_cast<std::size_t>(a)];
        EXPECT_NEAR(integral(density, &v), momentum[a], 1e-6 * std::abs(momentum[a]));
    }
    const auto& temperature = frame.find("temperature")->component[0];
    EXPECT_NEAR(integral(density, &temperature), heat, 1e-6 * heat);
    EXPECT_NEAR(integral(density, &frame.find("color")->component[0]), red, 1e-6 * red);
}

// A large particle: the centre of mass of its field is its own, and the field ends at the kernel's
// radius.
TEST(Splat, PutsAParticleWhereItIs) {
    Particles p;
    p.resize(1);
    p.position[0] = {0.03, 3.91, 3.88};
    p.radius[0] = 0.55f;
    Frame frame;
    Job job;
    splat_particles(p, lattice, {}, frame, job);
    const Field& field = *frame.find("density");
    const TileField<float>& density = field.component[0];
    Vec3d moment;
    double sum = 0;
    for (int t = 0; t < density.map().size(); ++t) {
        for (int i = 0; i < tile_values; ++i) {
            const double d = static_cast<double>(density.tile(t)[i]);
            const Vec3i cell = density.map().first_cell(t) + tile_shape_3d.cell(i);
            const Vec3d x = field.to_world.point(Vec3d(cell) + Vec3d(0.5));
            EXPECT_EQ(d > 0, length(x - p.position[0]) < 0.55f) << length(x - p.position[0]);
            moment += d * x;
            sum += d;
        }
    }
    EXPECT_LT(length(moment / sum - p.position[0]), 2e-3);
    EXPECT_EQ(frame.find("temperature"), nullptr);
}

TEST(Splat, IsTheSameOnAnyNumberOfThreads) {
    const Particles p = cloud_of(5000);
    const auto make = [&](int threads) {
        const ThreadLimit limit(threads);
        Frame frame;
        Job job;
        splat_particles(p, lattice, {}, frame, job);
        return frame;
    };
    const Frame one = make(1), two = make(2);
    for (const auto& [name, field] : one.fields) {
        for (std::size_t c = 0; c < field.component.size(); ++c) {
            EXPECT_EQ(field.component[c].values(), two.find(name)->component[c].values()) << name;
        }
    }
}

TEST(Splat, OfNothingOrFarAwayIsEmpty) {
    Particles p;
    Frame frame;
    Job job;
    splat_particles(p, lattice, {}, frame, job);
    EXPECT_EQ(frame.find("density")->map().size(), 0);
    p.resize(2);
    p.position = {{1e300, 0, 0}, {-1e9, 3, 4}};
    p.radius = {0.1f, 0.1f};
    splat_particles(p, lattice, {}, frame, job);
    EXPECT_EQ(frame.find("density")->map().size(), 0);
}

}  // namespace
}  // namespace gischt
