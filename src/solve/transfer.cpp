// SPDX-License-Identifier: Apache-2.0
#include "solve/transfer.h"

#include "base/parallel.h"

namespace gischt {
namespace {

// Values of a level by global cell, wrapped where the axis is periodic.
class CellView {
  public:
    CellView(const StencilLevel& level, const SplitField& field) : level_(level), field_(field) {}

    // 0 beyond other sides.
    float operator()(Vec3i c) const {
        if (!wrap(c)) return 0;
        const int tile = level_.map->find(level_.shape().tile_of(c));
        const Vec3i local = c - level_.map->first_cell(tile);
        return field_.tile(tile)[split_index(level_.shape(), local)];
    }

  private:
    bool wrap(Vec3i& c) const {
        for (int a = 0; a < 3; ++a) {
            const int n = level_.cells[a];
            if (c[a] >= 0 && c[a] < n) continue;
            const auto kind = level_.sides[static_cast<std::size_t>(2 * a)].kind;
            if (kind != SideRule::Kind::Periodic) return false;
            c[a] = (c[a] + n) % n;
        }
        return true;
    }

    const StencilLevel& level_;
    const SplitField& field_;
};

// Calls f(cell, local) for the cells of a tile inside the box.
template <class F>
void for_cells(const StencilLevel& level, int tile, F&& f) {
    const Vec3i first = level.map->first_cell(tile), size = level.map->cells_of(tile).size();
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; ++j) {
            for (int i = 0; i < size.x; ++i) f(first + Vec3i(i, j, k), Vec3i(i, j, k));
        }
    }
}

Vec3i unit(int axis, int end) {
    Vec3i v;
    v[axis] = end == 0 ? -1 : 1;
    return v;
}

bool is_red(const Vec3i& c) {
    return ((c.x + c.y + c.z) & 1) == 0;
}

// Sum of res over the red children of coarse cell c, all or (axis >= 0) those on one side of it.
float sum_red(const StencilLevel& fine, const CellView& res, const Vec3i& c, int axis, int end) {
    float sum = 0;
    for (int n = 0; n < (fine.is_2d() ? 4 : 8); ++n) {
        const Vec3i side{n & 1, n >> 1 & 1, n >> 2 & 1};
        if (axis >= 0 && side[axis] != end) continue;
        Vec3i child = c * 2 + side;
        if (fine.is_2d()) child.z = 0;
        const bool inside = min_component(fine.cells - child) > 0;
        if (inside && is_red(child)) sum += res(child);
    }
    return sum;
}

}  // namespace

void restrict_slow(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& res,
                   SplitField& coarse_r) {
    const CellView view(fine, res);
    parallel_for(static_cast<int>(coarse.active.size()), 1, [&](int n) {
        const int t = coarse.active[static_cast<std::size_t>(n)];
        for_cells(coarse, t, [&](const Vec3i& c, const Vec3i& local) {
            float r = sum_red(fine, view, c, -1, 0);
            for (int a = 0; a < coarse.axes(); ++a) {
                for (int end = 0; end < 2; ++end) {
                    const float w = face_weight(coarse, t, local, a, end);
                    if (w == 0) continue;
                    Vec3i next = c + unit(a, end);
                    const bool beyond = next[a] < 0 || next[a] >= coarse.cells[a];
                    const bool wraps = coarse.sides[static_cast<std::size_t>(2 * a)].kind ==
                                       SideRule::Kind::Periodic;
                    next[a] = (next[a] + coarse.cells[a]) % coarse.cells[a];
                    const float there =
                        beyond && !wraps ? 0.0f : sum_red(fine, view, next, a, 1 - end);
                    r += 0.25f * w / coarse.weight * (there - sum_red(fine, view, c, a, end));
                }
            }
            coarse_r.tile(t)[split_index(coarse.shape(), local)] = r;
        });
    });
}

void prolong_slow(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& e,
                  const SplitField& r, SplitField& z) {
    const CellView view(coarse, e);
    parallel_for(static_cast<int>(fine.active.size()), 1, [&](int n) {
        const int t = fine.active[static_cast<std::size_t>(n)];
        for_cells(fine, t, [&](const Vec3i& cell, const Vec3i& fine_local) {
            if (!is_red(cell)) return;
            const Vec3i c{cell.x >> 1, cell.y >> 1, cell.z >> 1};
            const int parent = coarse.map->find(coarse.shape().tile_of(c));
            const Vec3i local = c - coarse.map->first_cell(parent);
            const float own = view(c);
            float value = own;
            for (int a = 0; a < coarse.axes(); ++a) {
                const int end = cell[a] & 1;
                const float w = face_weight(coarse, parent, local, a, end);
                if (w != 0) value += 0.25f * w / coarse.weight * (view(c + unit(a, end)) - own);
            }
            const int at = split_index(fine.shape(), fine_local);
            z.tile(t)[at] = fine.block_of(t).inverse_diagonal[0][at] * r.tile(t)[at] + value;
        });
    });
}

}  // namespace gischt
