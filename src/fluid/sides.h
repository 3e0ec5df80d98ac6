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

}  // namespace gischt
