// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/light_grid.h"
#include "schema/table.h"

namespace gischt {

// The grid that media are brought onto for graphics hardware.
struct GridParams {
    int resolution = 128;  // most cells along the longest edge
    LightGridMethod light = LightGridMethod::Sweep;
    int sky_directions = 32;  // from which the grid takes the light of a sky; 0: none of it
};

const Table<GridParams>& grid_params_table();

}  // namespace gischt
