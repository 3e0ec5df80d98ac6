// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/advect.h"

namespace gischt {

// Gives the faces on the sides of the domain the values that the sides ask for: zero through walls,
// what an inflow holds; the last face of a periodic axis repeats the first, being the same face.
// Open sides are left.
void close_sides(const Domain& domain, FaceField& velocity);

// Marks the blocks along sides that hold a scalar at anything but zero: it may come in there.
void activate_sides(const Domain& domain, const BlockMap& blocks, const ScalarHold& hold,
                    SparseField& field);

// Gives what comes in through open sides the pressure of air that was at rest: lower by rho u^2 / 2
// than outside (Bernoulli), which without it nothing holds back: velocities that continue evenly
// beyond a side bring as much momentum in as they like, until the solution blows up. Over dt
// seconds, implicit: u = u / (1 + u dt / (2 h)).
void slow_inflow(const Domain& domain, double dt, FaceField& velocity);

}  // namespace gischt
