// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "fluid/particles/emission.h"
#include "fluid/particles/motion.h"
#include "schema/table.h"

namespace gischt {

// The box in which particles live and become a density.
struct ParticleDomain {
    int resolution = 128;                // cells along the longest edge
    Vec3d min{-1, -1, 0}, max{1, 1, 2};  // m
};

// The motion of another fluid, which carries the particles along as drag lets it.
struct FlowParams {
    std::string fluid;  // name of one of the scene
    std::string file;   // or VDB files, as a fluid of type "file" takes them
};

// What particles are by their age, over age / life in [0,1].
struct ParticleLook {
    Keyed<double> size = 1.0;     // times the radius
    Keyed<double> opacity = 1.0;  // [0,1]
    std::optional<Keyed<Vec3d>> color;
    std::optional<Keyed<double>> temperature;  // K
};

// A particle system: drops, sparks, dust, snow.
struct ParticleParams {
    ParticleDomain domain;
    std::vector<SpoutParams> sources;
    MotionParams motion;
    AirParams air;
    FlowParams flow;
    ParticleLook look;
    double gravity_scale = 1;
    double density = 1;               // of the field inside of a particle
    double reference_density = 1000;  // kg/m^3, of its matter
    double splat_scale = 1;           // radius of the kernel against the particle's
    int substeps = 4;                 // per frame
    int most_particles = 10'000'000;
    std::int64_t seed = 1;
};
const Table<ParticleParams>& particle_table();

}  // namespace gischt
