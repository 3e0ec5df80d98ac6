// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "solve/stencil_build.h"

namespace gischt {
namespace {

// The fine tiles below a coarse one, -1 where there is none; 4 in 2-D.
std::array<int, 8> children_of(const StencilLevel& fine, const Vec3i& coarse_coord) {
    std::array<int, 8> child;
    for (int c = 0; c < 8; ++c) {
        const Vec3i offset{c & 1, c >> 1 & 1, c >> 2 & 1};
        const bool exists = !(fine.is_2d() && offset.z != 0);
        Vec3i at = coarse_coord * 2 + offset;
        if (fine.is_2d()) at.z = 0;
        child[static_cast<std::size_t>(c)] = exists ? fine.map->find(at) : -1;
    }
    return child;
}

// Coefficients of the fine cells below one coarse tile.
class ChildBlocks {
  public:
    ChildBlocks(const StencilLevel& fine, const std::array<int, 8>& child)
        : fine_(fine), child_(child) {}

    // `cell`: fine cell relative to the coarse tile's first one.
    float weight(const Vec3i& cell, int axis, int end) const {
        const int tile = tile_of(cell);
        return tile < 0 ? 0.0f : face_weight(fine_, tile, local(cell), axis, end);
    }
    float extra(const Vec3i& cell) const {
        const int tile = tile_of(cell);
        if (tile < 0) return 0;
        const int at = split_index(fine_.shape(), local(cell));
        return fine_.block_of(tile).extra[at / color_values][at % color_values];
    }

  private:
    int tile_of(const Vec3i& cell) const {
        const Vec3i t = fine_.shape().tile_of(cell);
        return child_[static_cast<std::size_t>(t.x + 2 * t.y + 4 * t.z)];
    }
    Vec3i local(const Vec3i& c) const {
        const Vec3i n = fine_.shape().extent();
        return {c.x & (n.x - 1), c.y & (n.y - 1), c.z & (n.z - 1)};
    }

    const StencilLevel& fine_;
    std::array<int, 8> child_;
};

// Sums the fine faces of coarse cells. Half of the sum is the weight over twice the distance; on a
// Fixed side the ratio of distances is another one.
void sum_children(const StencilLevel& fine, const StencilLevel& coarse, int tile,
                  const ChildBlocks& child, StencilBlock& block) {
    const TileShape& shape = coarse.shape();
    const Vec3i first = coarse.map->first_cell(tile), size = coarse.map->cells_of(tile).size();
    const int children = coarse.is_2d() ? 4 : 8;
    for (int v = 0; v < tile_values; ++v) {
        const Vec3i c = shape.cell(v);
        if (c.x >= size.x || c.y >= size.y || c.z >= size.z) continue;
        const int at = split_index(shape, c), color = at / color_values, i = at % color_values;
        for (int n = 0; n < children; ++n) {
            const Vec3i side{n & 1, n >> 1 & 1, n >> 2 & 1};
            Vec3i cell = c * 2 + side;
            if (coarse.is_2d()) cell.z = 0;
            block.extra[color][i] += child.extra(cell);
            for (int a = 0; a < coarse.axes(); ++a) {
                float* lower = block.weight[color][direction_of(c, a, 0)] + i;
                float* upper = block.weight[color][direction_of(c, a, 1)] + i;
                // The last cell may have lower children only; their upper faces are its own.
                const bool is_last = 2 * first[a] + cell[a] == fine.cells[a] - 1;
                if (side[a] == 0) *lower += 0.5f * child.weight(cell, a, 0);
                if (side[a] == 1 || is_last) *upper += 0.5f * child.weight(cell, a, 1);
            }
        }
        for (int a = 0; a < coarse.axes(); ++a) {
            for (int end = 0; end < 2; ++end) {
                if (first[a] + c[a] != (end == 0 ? 0 : coarse.cells[a] - 1)) continue;
                const double below = side_ratio(fine, a, end);
                const double ratio = below > 0 ? side_ratio(coarse, a, end) / below : 0;
                block.weight[color][direction_of(c, a, end)][i] *= static_cast<float>(ratio);
            }
        }
    }
    finish_block(block, coarse.axes());
}

}  // namespace

StencilLevel make_coarser(const StencilLevel& fine) {
    StencilSpec spec;
    spec.sides = fine.sides;
    spec.shift = std::ldexp(fine.shift, -fine.depth * fine.axes());
    StencilLevel coarse =
        make_open_level(full_map((fine.cells + Vec3i(1)) / Vec3i(2), fine.shape()), spec,
                        fine.finest_cells, fine.depth + 1);

    // Above open tiles the coefficients are those of the open box; the others sum up their own.
    const int tiles = coarse.map->size();
    std::vector<char> own(static_cast<std::size_t>(tiles), 0);
    for (int t = 0; t < tiles; ++t) {
        bool closed = true;
        for (const int c : children_of(fine, coarse.map->coord(t))) {
            if (c < 0) continue;
            const bool is_closed =
                fine.block[static_cast<std::size_t>(c)] == StencilLevel::closed_block;
            closed = closed && is_closed;
            if (is_closed || fine.is_own(c)) own[static_cast<std::size_t>(t)] = 1;
        }
        if (closed) {
            own[static_cast<std::size_t>(t)] = 0;
            coarse.block[static_cast<std::size_t>(t)] = StencilLevel::closed_block;
        }
    }
    add_own_blocks(coarse, own);
    parallel_for(tiles, 1, [&](int t) {
        if (!coarse.is_own(t)) return;
        const ChildBlocks child(fine, children_of(fine, coarse.map->coord(t)));
        sum_children(
            fine, coarse, t, child,
            coarse.blocks[static_cast<std::size_t>(coarse.block[static_cast<std::size_t>(t)])]);
    });
    list_active(coarse);
    return coarse;
}

}  // namespace gischt
