// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/grid_params.h"

namespace gischt {

const Table<GridParams>& grid_params_table() {
    using P = GridParams;
    static const Table<P> table =
        Table<P>("grid", "The regular grid that media are brought onto for graphics hardware")
            .add("resolution", &P::resolution,
                 {.unit = "cells",
                  .help =
                      "Most cells along the longest edge; a volume of fewer voxels keeps its own",
                  .min = 4,
                  .max = 1024})
            .choice("light", &P::light,
                    {{"sweep", LightGridMethod::Sweep, "front to back, one step per cell"},
                     {"bresenham", LightGridMethod::Bresenham,
                      "the classical way: a Bresenham line from every cell to the light"},
                     {"exact", LightGridMethod::Exact, "every voxel with its length: the check"}},
                    {.help = "How the light that reaches each cell is found"})
            .add(
                "sky_directions", &P::sky_directions,
                {.help = "Directions from which light of a sky comes to the cells; 0 leaves it out",
                 .min = 0,
                 .max = 1024});
    return table;
}

}  // namespace gischt
