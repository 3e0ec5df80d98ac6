// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "grid/frame.h"
#include "io/vdb_header.h"

namespace gischt {

// A grid of a VDB file on tiles, before names and units are settled.
struct VdbGrid {
    std::string name;
    Field field;                  // to_world as if index (i,j,k) were the centre of its cell
    bool is_staggered = false;    // component a lives on the lower face along axis a
    std::int64_t bad_values = 0;  // not finite, replaced by the background
    std::map<std::string, std::string> metadata;
};

// Averages a staggered vector field to the centres: component a of cell c is the mean of the
// stored ones of c and of its upper neighbour along a (outside of the tiles: the background).
void center_components(Field& field);

// One vector field from three scalar ones. They share a transform, or each is half a cell lower
// along its own axis (faces) and is averaged; nothing when neither holds.
std::optional<Field> merge_components(const std::array<const Field*, 3>& components);

// Moves every grid by half a cell so that the file's transform maps cell corners.
void shift_half_voxel(Field& field);

// The frame of all grids, by name and unit (customary) or as they are; metadata, frame number, time
// and dt from the header and, for want of a frame number there, from the digits that end the
// file's name. Remarks go to the job.
Frame assemble_frame(std::vector<VdbGrid> grids, const VdbHeader& header, const std::string& path,
                     bool customary, Job& job);

}  // namespace gischt
