// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/side_params.h"
#include "grid/gather.h"
#include "math/vec.h"

namespace gischt {

struct Domain;
struct Lattice;
struct ScalarSides;
struct VelocitySides;

// What the sides hold a scalar at, as a deviation from the ambient, and how it continues beyond
// them. Odd: held on the side itself, a ghost is 2 value - mirror. Zero: a ghost is the value.
struct ScalarHold {
    Borders borders;
    std::array<float, 6> value{};
    bool is_plain = true;  // all zero
};

// What the sides of a domain hold at one moment.
struct SideValues {
    std::array<Vec3f, 6> velocity{};  // m/s, of no-slip walls and inflows (its largest)
    bool is_moving = false;           // any of them is not zero
    ScalarHold density;               // 1
    ScalarHold temperature;           // T - T_ambient, K
};

// At a time in seconds. `ambient` temperature in K.
SideValues side_values_at(const Domain& domain, double time, double ambient);

// Normal velocity of an inflow at a face on it, m/s: the side's times the profile, which in 3-D is
// the product of two parabolas, 16 y (H - y) z (W - z) / (H W)^2. Edges shared with periodic and
// free-slip sides do not slow it.
float inflow_velocity(const Domain& domain, int axis, int end, const Vec3i& face);

// Largest |component| of what the sides hold, m/s, and largest |value|.
double top_side_speed(const SideValues& values);
double top_side_value(const ScalarHold& hold);

// What gather_block_faces() with velocity_borders(axis) (gather_block() with the hold's borders)
// leaves out beyond the sides: adds the held values. No-ops where all are zero.
void add_side_velocity(const Domain& domain, int axis, const Lattice& lattice, float* values);
void add_side_scalar(const Domain& domain, const ScalarHold& hold, const Lattice& lattice,
                     float* values);

// The same for diffusion, which holds an inflow's values on the side itself.
VelocitySides velocity_sides(const Domain& domain);
ScalarSides scalar_sides(const Domain& domain, const ScalarHold& hold);

}  // namespace gischt
