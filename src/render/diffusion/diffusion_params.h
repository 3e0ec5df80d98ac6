// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "schema/table.h"

namespace gischt {

// The parameters of the diffusion method.
struct DiffusionParams {
    int resolution = 64;    // cells along the longest edge
    int light_samples = 4;  // points per cell and directions per light
    double tolerance = 1e-5;
    double step = 1, step_depth = 0.5;
};

const Table<DiffusionParams>& diffusion_table();

}  // namespace gischt
