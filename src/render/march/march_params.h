// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "schema/table.h"

namespace gischt {

// The parameters of the march: eq. 19 along camera rays, light by a second march or from grids.
struct MarchParams {
    double step = 1;          // largest step in voxels
    double step_depth = 0.5;  // largest optical depth of a step
    double shadow_step = 1;   // step of the second march in voxels
    double cutoff = 1e-3;     // the march ends at this transmittance

    bool light_cache = true;                // light on grids, computed once for a frame
    std::int64_t cache_nodes = 40'000'000;  // nodes of one grid; beyond, it is made coarser
    double shadow_spacing = 0;  // voxels between the nodes of a grid of shadow; 0: by thickness
    int sky_nodes = 300'000;    // of a grid of sky light, at least half a voxel apart
    int sky_directions = 128;   // from which the grid takes the sky

    // With a depth above 1, eq. 20.
    int directions = 4;     // in which light is gathered at a place
    double gathers = 4;     // places on a ray that scatters all of the light; 0: every step
    double thinning = 0.5;  // factor of both from one level of rays to the next
    double deep_step = 2;   // steps of gathering rays over those of camera rays

    int sky_samples = 4;  // directions per set at a surface point; without cache per step too
};

const Table<MarchParams>& march_table();

}  // namespace gischt
