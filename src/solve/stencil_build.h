// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/stencil.h"

// What make_finest and make_coarser have in common.
namespace gischt {

// Where the coefficient of the face of a cell lies in a StencilBlock.
constexpr Direction direction_of(const Vec3i& local, int axis, int end) {
    if (axis == 0) return end == 0 ? Left : Right;
    if (axis == 2) return end == 0 ? Back : Front;
    return (local.y & 1) == end ? OtherRow : SameRow;
}

// Weight of an open face on a side of the box in units of an inner one: 0 for Closed, 1 for
// Periodic, cell edge over distance for Fixed, since that place stays where it is at all levels.
double side_ratio(const StencilLevel& level, int axis, int end);

// All tiles of the box [0, cells), of this shape even where the box is one cell thick.
TileMap::Ptr full_map(const Vec3i& cells, const TileShape& shape);

// Sets a level's geometry, links tiles and ghosts, and gives all tiles the shared block that their
// place in the box demands; own blocks are up to the caller.
StencilLevel make_open_level(TileMap::Ptr map, const StencilSpec& spec, const Vec3i& finest_cells,
                             int depth);

// Appends a zeroed block for each tile with `wanted` and makes the tile use it.
void add_own_blocks(StencilLevel& level, const std::vector<char>& wanted);

// Computes the diagonal of a block from its weights.
void finish_block(StencilBlock& block, int axes);

// Lists the tiles that are not closed.
void list_active(StencilLevel& level);

}  // namespace gischt
