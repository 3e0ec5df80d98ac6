// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "math/box.h"

namespace gischt {

// A set of particles, one array per quantity. `id` is unique in its set and stays with a particle
// for life; who needs random numbers for a particle derives them from it.
struct Particles {
    std::vector<Vec3d> position;    // m
    std::vector<Vec3f> velocity;    // m/s
    std::vector<float> age, life;   // s; a particle is there while age < life
    std::vector<float> radius;      // m
    std::vector<std::uint64_t> id;  // what it is called
    // Each empty, or one per particle.
    std::vector<Vec3f> color;        // linear; empty: white
    std::vector<float> opacity;      // [0,1]; empty: 1
    std::vector<float> temperature;  // K; empty: unknown

    std::size_t size() const { return position.size(); }
    bool is_empty() const { return position.empty(); }
    void resize(std::size_t count);
    // Box around all positions; empty where there are none.
    Box3d bounds() const;
    bool operator==(const Particles&) const = default;
};

// Calls f(array) for the arrays that every particle has, in the order of the declaration; `f` takes
// any std::vector.
template <class P, class F>
void for_particle_arrays(P& particles, F&& f) {
    f(particles.position);
    f(particles.velocity);
    f(particles.age);
    f(particles.life);
    f(particles.radius);
    f(particles.id);
}

// The same with the arrays that may be empty, which it passes only where they are not.
template <class P, class F>
void for_all_particle_arrays(P& particles, F&& f) {
    for_particle_arrays(particles, f);
    if (!particles.color.empty()) f(particles.color);
    if (!particles.opacity.empty()) f(particles.opacity);
    if (!particles.temperature.empty()) f(particles.temperature);
}

// Keeps the particles whose flag is not 0, in their order. One flag per particle.
void keep_particles(Particles& particles, const std::vector<std::uint8_t>& keep);

}  // namespace gischt
