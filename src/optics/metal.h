// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "optics/material.h"

namespace gischt {

// Complex index of refraction eta + i k of a metal for the channels of Rec.709.
struct MetalIndex {
    Vec3f eta, k;
};

// From the measurements of Johnson & Christy (1972) for gold, copper and silver and of Rakic (1995)
// for aluminium, averaged over each primary. Iron and chrome have eta by Johnson & Christy (1974)
// and the k that gives the reflectance at normal incidence of Hoffman (2010), as Gulbrandsen (2014,
// "Artist friendly metallic Fresnel") computes it.
MetalIndex metal_index(Metal metal);

}  // namespace gischt
