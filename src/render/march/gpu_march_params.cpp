// SPDX-License-Identifier: Apache-2.0
#include "render/march/gpu_march_params.h"

namespace gischt {

const Table<GpuMarchParams>& gpu_march_table() {
    using P = GpuMarchParams;
    static const Table<P> table =
        Table<P>("gpu_march", "Ray marching with direct light on graphics hardware, in one pass")
            .flat(&P::grid, grid_params_table())
            .add("step", &P::step,
                 {.unit = "cells",
                  .help = "Largest step along a camera ray",
                  .min = 0.05,
                  .max = 16})
            .add("step_depth", &P::step_depth,
                 {.help = "Largest optical depth of a step: dense media get shorter ones",
                  .min = 0.01,
                  .max = 100})
            .add("cutoff", &P::cutoff,
                 {.help = "Transmittance at which a camera ray ends", .min = 0, .max = 0.1});
    return table;
}

}  // namespace gischt
