// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/smoke.h"

namespace gischt {

// The fields of a solver's state that its `output` asks for: density and temperature (K) on the
// tiles with any, velocity (m/s) at cell centres, pressure (Pa), vorticity (1/s).
Frame make_frame(const SmokeSolver& solver, int number);

// Tiles that hold density or heat.
int count_active_tiles(const SmokeSolver& solver);

}  // namespace gischt
