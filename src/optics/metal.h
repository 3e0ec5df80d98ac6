// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "optics/material.h"

namespace gischt {

// Complex index of refraction eta + i k of a metal for the channels of Rec.709.
struct MetalIndex {
    Vec3f eta, k;
};

// From the measurements of Johnson & Christy (1972: gold, copper, silver; 1974: iron), Rakic (1998:
// aluminium) and Rakic et al. (1998: chrome), averaged over each primary.
MetalIndex metal_index(Metal metal);

}  // namespace gischt
