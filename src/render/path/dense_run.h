// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/path/media_walk.h"

namespace gischt {

// Where the bounds of a run are so far apart that null collisions would not end (a voxel of 1e30
// beside one of 1), the density is integrated cell by cell instead (regular tracking: Sutton et
// al. 1999). Costs at most two look-ups per cell and medium, whatever the density.

// Integral of the density over [t0, t1] of a segment of a medium with a grid, in t: exact but for
// rounding. Two Gauss points in each interpolation cell, in which the density is a cubic of t.
double exact_integral(const Medium& medium, const MediumSegment& segment, std::int64_t& lookups);

// Optical depth of a run per channel. All its media must have a grid.
Vec3f exact_depth_of_run(const MediaRun& run, std::int64_t& lookups);

// Whether a run can be cut into cells: all its media have a grid, or are even in it.
bool has_cells(const MediaRun& run);

// The cells of the rest of a run, from t on, each with its optical depth.
struct RunCell {
    double t = 0;
    float length = 0;
    Vec3f depth;
};
void cells_of_run(const MediaRun& run, double t, std::vector<RunCell>& cells,
                  std::int64_t& lookups);

// Optical depth per channel of the first s metres of a cell.
Vec3f depth_within_cell(const MediaRun& run, const RunCell& cell, float s, std::int64_t& lookups);

}  // namespace gischt
