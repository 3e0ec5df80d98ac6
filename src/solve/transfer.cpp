// SPDX-License-Identifier: Apache-2.0
#include "solve/transfer.h"

#include "base/parallel.h"
#include "solve/stencil_build.h"

namespace gischt {
namespace {

// A dense copy of the values around one coarse tile, with one coarse cell more on each side, in
// natural order. Periodic axes wrap; zero beyond other sides and where a coarse cell lacks a child.
class Patch {
  public:
    // The coarse field itself.
    static Patch of_cells(const StencilLevel& level, const SplitField& field, int tile) {
        return Patch(level, field, tile, level, 1);
    }
    // The children of the coarse cells, two per axis.
    static Patch of_children(const StencilLevel& fine, const SplitField& field,
                             const StencilLevel& coarse, int coarse_tile) {
        return Patch(fine, field, coarse_tile, coarse, 2);
    }

    // Cell (or child) relative to the tile's first.
    float operator()(const Vec3i& c) const {
        const Vec3i i = c + halo_;
        return values_[static_cast<std::size_t>(i.x + size_.x * (i.y + size_.y * i.z))];
    }

  private:
    Patch(const StencilLevel& level, const SplitField& field, int tile, const StencilLevel& coarse,
          int per_cell) {
        halo_ = size_ = Vec3i(1);
        std::array<std::vector<int>, 3> source;
        const Vec3i first = coarse.map->first_cell(tile), extent = coarse.shape().extent();
        for (int a = 0; a < 3; ++a) {
            const bool flat = a >= coarse.axes();
            halo_[a] = flat ? 0 : per_cell;
            size_[a] = flat ? 1 : per_cell * (extent[a] + 2);
            for (int i = 0; i < size_[a]; ++i) {
                source[static_cast<std::size_t>(a)].push_back(
                    flat ? 0
                         : source_of(level, coarse, a, first[a] - 1 + i / per_cell, per_cell,
                                     i % per_cell));
            }
        }
        values_.reserve(volume(size_));
        for (const int z : source[2]) {
            for (const int y : source[1]) {
                for (const int x : source[0]) values_.push_back(value(level, field, {x, y, z}));
            }
        }
    }

    // Index on level's axis that coarse cell c, or its child on the given side, takes; -1: none.
    static int source_of(const StencilLevel& level, const StencilLevel& coarse, int axis, int c,
                         int per_cell, int side) {
        const int n = coarse.cells[axis];
        if (c < 0 || c >= n) {
            const auto kind = coarse.sides[static_cast<std::size_t>(2 * axis)].kind;
            if (kind != SideRule::Kind::Periodic) return -1;
            c = (c + n) % n;
        }
        const int i = per_cell * c + side;
        return i < level.cells[axis] ? i : -1;
    }
    static float value(const StencilLevel& level, const SplitField& field, const Vec3i& c) {
        if (min_component(c) < 0) return 0;
        const int tile = level.map->find(level.shape().tile_of(c));
        return field.tile(tile)[split_index(level.shape(), c - level.map->first_cell(tile))];
    }

    Vec3i halo_, size_;
    std::vector<float> values_;
};

// Calls f(local) for the cells of a tile inside the box.
template <class F>
void for_cells(const StencilLevel& level, int tile, F&& f) {
    const Vec3i size = level.map->cells_of(tile).size();
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; ++j) {
            for (int i = 0; i < size.x; ++i) f(Vec3i(i, j, k));
        }
    }
}

Vec3i first_child(const StencilLevel& level, const Vec3i& c) {
    return {2 * c.x, 2 * c.y, level.is_2d() ? 0 : 2 * c.z};
}

// Calls f(side) for each child of a coarse cell.
template <class F>
void for_children(const StencilLevel& level, F&& f) {
    for (int n = 0; n < (level.is_2d() ? 4 : 8); ++n) f(Vec3i(n & 1, n >> 1 & 1, n >> 2 & 1));
}

// Sum over the children of c on one side.
float half_sum(const StencilLevel& level, const Patch& children, const Vec3i& c, int axis,
               int end) {
    float sum = 0;
    for_children(level, [&](const Vec3i& side) {
        if (side[axis] == end) sum += children(first_child(level, c) + side);
    });
    return sum;
}

Vec3i towards(Vec3i c, int axis, int end) {
    c[axis] += end == 0 ? -1 : 1;
    return c;
}

}  // namespace

void restrict_wrapped(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& res,
                      SplitField& coarse_r) {
    parallel_for(static_cast<int>(coarse.active.size()), 1, [&](int n) {
        const int t = coarse.active[static_cast<std::size_t>(n)];
        const Patch children = Patch::of_children(fine, res, coarse, t);
        for_cells(coarse, t, [&](const Vec3i& c) {
            float r = half_sum(coarse, children, c, 0, 0) + half_sum(coarse, children, c, 0, 1);
            for (int a = 0; a < coarse.axes(); ++a) {
                for (int end = 0; end < 2; ++end) {
                    const float w = 0.25f * face_weight(coarse, t, c, a, end) / coarse.weight;
                    if (w == 0) continue;
                    r += w * (half_sum(coarse, children, towards(c, a, end), a, 1 - end) -
                              half_sum(coarse, children, c, a, end));
                }
            }
            coarse_r.tile(t)[split_index(coarse.shape(), c)] = r;
        });
    });
}

void prolong_wrapped(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& e,
                     SplitField& z) {
    parallel_for(static_cast<int>(coarse.active.size()), 1, [&](int n) {
        const int t = coarse.active[static_cast<std::size_t>(n)];
        const Patch cells = Patch::of_cells(coarse, e, t);
        for_cells(coarse, t, [&](const Vec3i& c) {
            float slope[3][2] = {};
            for (int a = 0; a < coarse.axes(); ++a) {
                for (int end = 0; end < 2; ++end) {
                    const float w = 0.25f * face_weight(coarse, t, c, a, end) / coarse.weight;
                    if (w != 0) slope[a][end] = w * (cells(towards(c, a, end)) - cells(c));
                }
            }
            const Vec3i corner = first_child(coarse, coarse.map->first_cell(t) + c);
            for_children(coarse, [&](const Vec3i& side) {
                const Vec3i child = corner + side;
                if (min_component(fine.cells - child) <= 0) return;
                const int tile = fine.map->find(fine.shape().tile_of(child));
                const Vec3i local = child - fine.map->first_cell(tile);
                z.tile(tile)[split_index(fine.shape(), local)] +=
                    cells(c) + slope[0][side.x] + slope[1][side.y] + slope[2][side.z];
            });
        });
    });
}

}  // namespace gischt
