// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/realtime/grid_params.h"

namespace gischt {

// The parameters of the march on graphics hardware.
struct GpuMarchParams {
    GridParams grid;
    double step = 1;          // largest step in cells
    double step_depth = 0.5;  // largest optical depth of a step
    double cutoff = 1e-3;     // the march ends at this transmittance
};

const Table<GpuMarchParams>& gpu_march_table();

}  // namespace gischt
