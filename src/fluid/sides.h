// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/domain.h"

namespace gischt {

// Gives the faces on the sides of the domain the values that the sides ask for: zero through walls;
// the last face of a periodic axis repeats the first, being the same face. Open sides are left.
void close_sides(const Domain& domain, FaceField& velocity);

}  // namespace gischt
