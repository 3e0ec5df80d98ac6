// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/load.h"

namespace gischt {

// What one fluid of a scene will take, before anything is computed.
struct FluidEstimate {
    std::string name, source;      // source: smoke, file, cloud
    Vec3i cells;                   // zero where it is not known
    double cell_size = 0;          // m
    double memory = 0;             // bytes while it is computed
    double disk_per_frame = 0;     // bytes, when smoke fills a fifth of the domain
    double seconds_per_frame = 0;  // on two cores, one step per frame
};

// Throws Error{Usage} for what could not run: impossible domains, files that are not there.
std::vector<FluidEstimate> estimate_fluids(const Scene& scene);

// Seconds per picture on two cores, of a frame half filled by a medium.
double estimate_picture_seconds(const Scene& scene);

}  // namespace gischt
