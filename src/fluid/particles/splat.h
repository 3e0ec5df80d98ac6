// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "grid/frame.h"

namespace gischt {

// The lattice on which particles become fields.
struct SplatLattice {
    Vec3i cells;
    double h = 0;  // edge of a cell, m
    Vec3d origin;  // m, corner of cell (0,0,0)
};

struct SplatOptions {
    double density = 1;       // of a particle's own matter
    double radius_scale = 1;  // of the kernel against the particle
};

// Particles as fields on sparse tiles: `density`; `velocity` (m/s), `temperature` (K) and `color`
// as means weighted by density, the last two where the particles have them. A particle counts with
// density opacity 4/3 pi radius^3, spread by the kernel (1 - (r/R)^2)^3 of R = radius_scale radius,
// at least 1.5 cells (Mueller, Charypar, Gross 2003). The kernel's sum over the cells inside the
// lattice is 1, so that the integral of the field is that of the particles to the rounding of
// float; particles without a cell near add nothing. The same bits on any number of threads.
void splat_particles(const Particles& particles, const SplatLattice& lattice,
                     const SplatOptions& options, Frame& frame, Job& job);

// Volume of a particle's matter times its density and opacity, m^3.
double particle_content(const Particles& particles, std::size_t i, double density);

}  // namespace gischt
