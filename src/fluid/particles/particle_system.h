// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "base/job.h"
#include "fluid/particles/particle_params.h"
#include "fluid/source.h"

namespace gischt {

// Particles and what moves them. A million take about 60 MB.
class ParticleSystem {
  public:
    // `meshes`: one per source of `params`, used where that is a mesh; may be shorter. Throws
    // Error{Usage} on parameters that make no sense.
    ParticleSystem(const ParticleParams& params, const FluidWorld& world,
                   std::span<const Mesh> meshes);
    ParticleSystem(const ParticleSystem&) = delete;  // parts refer to each other
    ParticleSystem& operator=(const ParticleSystem&) = delete;

    // Gives, moves and takes away particles. Steps must follow each other. Every particle goes its
    // own way: the same bits on any number of threads. Throws Error{Usage} beyond most_particles.
    void step(double from, double to, Job& job);
    // See Air::set_flow().
    Air& air() { return air_; }

    const Particles& particles() const { return particles_; }
    void set_particles(Particles particles) { particles_ = std::move(particles); }
    const ParticleParams& params() const { return params_; }

    // The particles as they look at their age: radius, opacity, colour and temperature.
    Particles seen() const;

  private:
    void check_room(double from, double to) const;

    ParticleParams params_;
    std::vector<SolidParams> solids_;
    std::vector<Spout> spouts_;
    Air air_;
    Mover mover_;
    Particles particles_;
};

}  // namespace gischt
