// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid/field.h"
#include "solve/split_field.h"

namespace gischt {

// What lies beyond one side of the box, for the unknown x.
struct SideRule {
    enum class Kind {
        Closed,    // nothing flows
        Fixed,     // x = 0 at `distance` cells beyond the centre of the last cell
        Periodic,  // the other side
    };
    Kind kind = Kind::Closed;
    double distance = 1;
};
using SideRules = std::array<SideRule, 6>;

// A symmetric operator on the cells of a box map:
//   (A x)_c = e_c x_c + sum over the faces of w_f (x_c - x_n),
// e_c = shift + extra_c >= 0, w_f >= 0 the open fraction of the face or any other conductance of it
// (best near 1), x_n = 0 beyond a Fixed side.
struct StencilSpec {
    TileMap::Ptr map;
    SideRules sides{};
    const FaceField* fraction = nullptr;      // null: all 1
    double shift = 0;                         // > 0: Helmholtz, 0: Poisson
    const TileField<float>* extra = nullptr;  // null: all 0
    int max_levels = 32;                      // of the multigrid hierarchy
};

// Directions of the neighbours as the kernels see them in split order. SameRow and OtherRow are the
// two y neighbours: a cell in the lower row of a packed row has +y in the same packed row, one in
// the upper row -y.
enum Direction { Left, Right, SameRow, OtherRow, Back, Front, direction_count };

// Coefficients of a tile in split order [colour][...][256].
struct alignas(64) StencilBlock {
    float weight[2][direction_count][color_values];
    float extra[2][color_values];
    float inverse_diagonal[2][color_values];  // 0 where the cell is left out
};

// One level of the hierarchy: topology and coefficients. Cell size is 2^depth in units of the
// finest. Tiles of one kind share a block; most of them are of the kind `constant_block`.
struct StencilLevel {
    static constexpr int constant_block = 0;  // all weights equal to `weight`, nothing left out
    static constexpr int closed_block = 1;    // all cells left out

    TileMap::Ptr map;
    Vec3i cells, finest_cells;
    SideRules sides;
    int depth = 0;
    double shift = 0;                                     // e of a full cell
    float weight = 1;                                     // w of a full open face
    std::vector<std::array<std::int32_t, 6>> neighbours;  // -x +x -y +y -z +z: tile, ghost or zero
    std::vector<std::int32_t> block;                      // by tile
    AlignedVector<StencilBlock> blocks;
    int first_own_block = 0;           // blocks from here on belong to one tile each
    std::vector<std::int32_t> active;  // tiles that are not closed, in Morton order
    int tiles_with_ghosts = 0;         // size of the level's fields; the last tile is the zero tile

    // Where a periodic extent is not a multiple of the tile's, cells just beyond a side are copies:
    // field value `to` = value `from`.
    struct Copy {
        std::int32_t to, from;
    };
    std::vector<Copy> copies;

    const TileShape& shape() const { return map->shape(); }
    bool is_2d() const { return map->is_2d(); }
    int axes() const { return is_2d() ? 2 : 3; }
    bool is_own(int tile) const { return block[static_cast<std::size_t>(tile)] >= first_own_block; }
    const StencilBlock& block_of(int tile) const {
        return blocks[static_cast<std::size_t>(block[static_cast<std::size_t>(tile)])];
    }
};

// The six coefficients of a cell in geometric order -x +x -y +y -z +z; slow.
float face_weight(const StencilLevel& level, int tile, const Vec3i& local, int axis, int end);

// Fills the ghosts of a field of the level. `only_red`: copies of black cells become zero, as for
// a field whose black cells count as zero. A no-op where nothing is copied.
void fill_ghosts(const StencilLevel& level, SplitField& field, bool only_red = false);

// Level 0 of a specification.
StencilLevel make_finest(const StencilSpec& spec);

// The level with cells of twice the edge; face weights are sums over the four (two) fine faces,
// halved for the doubled distance; what lies beyond a Fixed side keeps its place.
StencilLevel make_coarser(const StencilLevel& fine);

}  // namespace gischt
