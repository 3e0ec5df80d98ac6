// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fluid/smoke.h"

namespace gischt {

// Integrals over the fluid. In 2-D they are per metre of depth: J/m for J, m^2 for m^3.

struct EnergySample {
    double kinetic_energy = 0;  // J: rho |u|^2 / 2, with the squares of the face values
    double enstrophy = 0;       // m^3/s^2: |curl u|^2 / 2, the curl on edges, of 2 cells width
    double max_speed = 0;       // m/s, at cell centres
};
// Covered parts of faces and cells whose centre is covered do not count.
EnergySample measure_energy(const SmokeSolver& solver);

struct AmountSample {
    double volume = 0;  // m^3: integral of the density
    double mass = 0;    // kg: times the reference density
    double heat = 0;    // K m^3: integral of the temperature above the ambient
};
// In a box, whose sides may cut cells, or in the whole domain.
AmountSample measure_amount(const SmokeSolver& solver, const std::optional<Box3d>& box);

// The largest dot(direction, x) where a scalar is above the threshold (below, if that is negative),
// interpolated linearly between cell centres; NaN where there is none. `direction` is a unit
// vector; `is_density`: the density, else the temperature above the ambient.
double measure_front(const SmokeSolver& solver, const Vec3d& direction, bool is_density,
                     double threshold);

// Fluxes through a level.
struct PlumeSample {
    double volume_flux = 0;    // Q = integral of w, m^3/s
    double momentum_flux = 0;  // M = integral of w^2, m^4/s^2
    double buoyancy_flux = 0;  // F = integral of w g', m^4/s^3
};
// The axis along which gravity points, and +1 where up is its positive direction. Throws
// Error{Usage} where gravity is zero or oblique to the grid.
struct UpDirection {
    int axis = 2;
    int sign = 1;
};
UpDirection up_direction(const Vec3d& gravity);

// At a coordinate of the domain along the axis of gravity. Cells with less than `threshold` times
// the largest buoyancy of the level do not count. Integrals lie on levels of faces and are linear
// between them.
PlumeSample measure_plume(const SmokeSolver& solver, double level, double threshold);

// The plume of uniform speed and buoyancy with these fluxes (top hat; Morton, Taylor, Turner 1956):
// Q = pi b^2 w and M = Q w; in 2-D Q = 2 b w.
struct TopHat {
    double radius = 0;   // b, m; in 2-D half the width
    double speed = 0;    // w, m/s
    double gravity = 0;  // g', m/s^2
};
TopHat top_hat(const PlumeSample& fluxes, bool is_2d);

}  // namespace gischt
