// SPDX-License-Identifier: Apache-2.0
#include "render/diffusion/diffusion_params.h"

namespace gischt {

const Table<DiffusionParams>& diffusion_table() {
    static const Table<DiffusionParams> table =
        Table<DiffusionParams>("diffusion", "Multiple scattering as a diffusion process")
            .add("resolution", &DiffusionParams::resolution,
                 {.help = "Cells along the longest edge of the box around the media",
                  .min = 4,
                  .max = 512})
            .add("light_samples", &DiffusionParams::light_samples,
                 {.help = "Points of each cell at which the light that comes straight from the "
                          "lights is averaged, with as many directions of each light",
                  .min = 1,
                  .max = 65536})
            .add("tolerance", &DiffusionParams::tolerance,
                 {.help = "Relative residual at which the diffusion equation counts as solved",
                  .min = 1e-7,
                  .max = 0.1})
            .add("step", &DiffusionParams::step,
                 {.unit = "voxels",
                  .help = "Largest step of the march that gathers the light",
                  .min = 0.01,
                  .max = 64})
            .add("step_depth", &DiffusionParams::step_depth,
                 {.help = "Largest optical depth of such a step", .min = 0.001, .max = 100});
    return table;
}

}  // namespace gischt
