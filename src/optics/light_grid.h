// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "optics/medium_bake.h"

namespace gischt {

// Where light comes from: a point, or a direction at infinity.
struct LightOrigin {
    bool is_infinite = true;
    Vec3d place{0, 0, 1};  // unit vector towards the light, or its position in metres
};

enum class LightGridMethod {
    Exact,      // every voxel with the length of the ray in it; the check of the others
    Bresenham,  // 3-D Bresenham lines, every voxel with the length l = |D| h / max|D_i|
    Sweep,      // front to back, each cell from those before it: one step per cell
};

// The light that reaches every cell of a grid: T_ray of the table in the architecture, the
// transmittance of all voxels between the light and the entry of the cell along the ray to its
// centre; 1 at the light. Exact and Bresenham cost the cells times the cells along a ray; Sweep
// costs the cells, 128^3 of them some 50 ms, but smears shadows by about the square
// root of the number of cells that they are long.
struct LightGrid {
    std::vector<float> transmittance;  // in the order of the extinction

    // Radiance-like shade of a cell, L = albedo L_light (1 - T_vox) T_ray.
    float shade(const ExtinctionGrid& grid, const LightOrigin& light, const Vec3i& cell,
                float albedo, float radiance) const;
};

// The optical depth from the light to the centre of every cell, in the order of the extinction.
std::vector<float> depths_to_centers(const ExtinctionGrid& grid, const LightOrigin& light,
                                     LightGridMethod method, Job& job);

LightGrid light_to_cells(const ExtinctionGrid& grid, const LightOrigin& light,
                         LightGridMethod method, Job& job);

}  // namespace gischt
