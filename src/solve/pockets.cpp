// SPDX-License-Identifier: Apache-2.0
#include "solve/pockets.h"

#include <array>
#include <numeric>

#include "base/parallel.h"
#include "solve/stencil_build.h"

namespace gischt {
namespace {

// Union-find over nodes: one per tile without cuts, 512 per tile with.
class Parts {
  public:
    explicit Parts(const StencilLevel& level) : level_(level) {
        int nodes = 0;
        first_.resize(static_cast<std::size_t>(level.map->size()));
        for (int t = 0; t < level.map->size(); ++t) {
            first_[static_cast<std::size_t>(t)] = nodes;
            nodes += level.is_own(t) ? tile_values : 1;
        }
        parent_.resize(static_cast<std::size_t>(nodes));
        std::iota(parent_.begin(), parent_.end(), 0);
        held_.assign(static_cast<std::size_t>(nodes), 0);
        for (const int t : level.active) {
            if (level.is_own(t)) join_inside(t);
            for (int a = 0; a < level.axes(); ++a) {
                for (int end = 0; end < 2; ++end) join_side(t, a, end);
            }
        }
    }

    std::size_t node(int tile, const Vec3i& local) const {
        const int first = first_[static_cast<std::size_t>(tile)];
        const int offset =
            level_.is_own(tile) ? level_.shape().index(local.x, local.y, local.z) : 0;
        return static_cast<std::size_t>(first + offset);
    }
    std::size_t nodes() const { return parent_.size(); }
    std::size_t root(std::size_t i) {
        while (static_cast<std::size_t>(parent_[i]) != i) {
            parent_[i] = parent_[static_cast<std::size_t>(parent_[i])];
            i = static_cast<std::size_t>(parent_[i]);
        }
        return i;
    }
    bool is_held(std::size_t root) const { return held_[root] != 0; }

  private:
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[b] = static_cast<int>(a);
        if (held_[b] != 0) held_[a] = 1;
    }
    void hold(std::size_t a) { held_[root(a)] = 1; }

    void join_inside(int t) {
        const Vec3i size = level_.map->cells_of(t).size();
        for (int v = 0; v < tile_values; ++v) {
            const Vec3i c = level_.shape().cell(v);
            const int at = split_index(level_.shape(), c);
            if (level_.block_of(t).extra[at / color_values][at % color_values] > 0) {
                hold(node(t, c));
            }
            for (int a = 0; a < level_.axes(); ++a) {
                Vec3i next = c;
                next[a] += 1;
                if (min_component(size - next) > 0 && face_weight(level_, t, c, a, 1) > 0) {
                    join(node(t, c), node(t, next));
                }
            }
        }
    }

    // Joins a tile with the next one, or holds what a Fixed side holds. The lower end only matters
    // at a side of the box.
    void join_side(int t, int a, int end) {
        const Vec3i first = level_.map->first_cell(t), size = level_.map->cells_of(t).size();
        const auto kind = level_.sides[static_cast<std::size_t>(2 * a + end)].kind;
        const bool at_side = end == 0 ? first[a] == 0 : first[a] + size[a] == level_.cells[a];
        if (!at_side && end == 0) return;
        if (at_side &&
            (kind == SideRule::Kind::Closed || (end == 0 && kind == SideRule::Kind::Periodic))) {
            return;
        }
        int next = -1;
        if (kind == SideRule::Kind::Periodic || !at_side) {
            Vec3i coord = level_.map->coord(t);
            coord[a] = at_side ? 0 : coord[a] + 1;
            next = level_.map->find(coord);
        }
        Vec3i lo, hi = size;
        lo[a] = end == 0 ? 0 : size[a] - 1;
        hi[a] = lo[a] + 1;
        for (int k = lo.z; k < hi.z; ++k) {
            for (int j = lo.y; j < hi.y; ++j) {
                for (int i = lo.x; i < hi.x; ++i) {
                    const Vec3i c{i, j, k};
                    if (!(face_weight(level_, t, c, a, end) > 0)) continue;
                    Vec3i there = c;
                    there[a] = 0;
                    next < 0 ? hold(node(t, c)) : join(node(t, c), node(next, there));
                    if (next < 0 ? !level_.is_own(t) : !level_.is_own(t) && !level_.is_own(next)) {
                        return;
                    }
                }
            }
        }
    }

    const StencilLevel& level_;
    std::vector<int> first_, parent_;
    std::vector<char> held_;
};

std::array<int, tile_values> split_order(const TileShape& shape) {
    std::array<int, tile_values> index;
    for (int v = 0; v < tile_values; ++v) {
        index[static_cast<std::size_t>(v)] = split_index(shape, shape.cell(v));
    }
    return index;
}

}  // namespace

Pockets::Pockets(const StencilLevel& level) {
    if (level.shift > 0) return;
    Parts parts(level);
    std::vector<int> pocket_of_root(parts.nodes(), none);
    tile_pocket_.assign(static_cast<std::size_t>(level.map->size()), none);
    first_label_.assign(tile_pocket_.size(), 0);
    const auto pocket_of = [&](std::size_t node) {
        const std::size_t root = parts.root(node);
        if (parts.is_held(root)) return none;
        if (pocket_of_root[root] == none) {
            pocket_of_root[root] = count();
            cells_.push_back(0);
        }
        return pocket_of_root[root];
    };
    const auto order = split_order(level.shape());
    for (const int t : level.active) {
        const auto tile = static_cast<std::size_t>(t);
        if (!level.is_own(t)) {
            tile_pocket_[tile] = pocket_of(parts.node(t, {}));
            if (tile_pocket_[tile] == none) continue;
            cells_[static_cast<std::size_t>(tile_pocket_[tile])] +=
                static_cast<double>(volume(level.map->cells_of(t).size()));
            continue;
        }
        tile_pocket_[tile] = by_cell;
        first_label_[tile] = static_cast<int>(labels_.size());
        for (std::size_t v = 0; v < order.size(); ++v) {
            const int at = order[v];
            const bool takes_part =
                level.block_of(t).inverse_diagonal[at / color_values][at % color_values] > 0;
            const Vec3i local = level.shape().cell(static_cast<int>(v));
            const int pocket = takes_part ? pocket_of(parts.node(t, local)) : none;
            labels_.push_back(pocket);
            if (pocket != none) cells_[static_cast<std::size_t>(pocket)] += 1;
        }
    }
}

void Pockets::remove_mean_split(const StencilLevel& level, float* values) const {
    remove_mean(level, split_order(level.shape()).data(), values);
}

void Pockets::remove_mean_natural(const StencilLevel& level, float* values) const {
    std::array<int, tile_values> identity;
    std::iota(identity.begin(), identity.end(), 0);
    remove_mean(level, identity.data(), values);
}

void Pockets::remove_mean(const StencilLevel& level, const int* index, float* values) const {
    if (is_empty()) return;
    const int tiles = level.map->size();
    const auto tile_of = [&](int t) { return values + static_cast<std::size_t>(t) * tile_values; };

    // Whole tiles are summed in parallel; then all is added in the order of the tiles.
    std::vector<double> whole(static_cast<std::size_t>(tiles), 0), mean(cells_.size(), 0);
    parallel_for(tiles, 16, [&](int t) {
        if (tile_pocket_[static_cast<std::size_t>(t)] < 0) return;
        double sum = 0;
        for (int v = 0; v < tile_values; ++v) sum += static_cast<double>(tile_of(t)[v]);
        whole[static_cast<std::size_t>(t)] = sum;
    });
    const auto for_cut_cells = [&](int t, auto&& f) {
        const int* label = labels_.data() + first_label_[static_cast<std::size_t>(t)];
        for (int v = 0; v < tile_values; ++v) {
            if (label[v] != none) f(static_cast<std::size_t>(label[v]), tile_of(t)[index[v]]);
        }
    };
    for (int t = 0; t < tiles; ++t) {
        const int pocket = tile_pocket_[static_cast<std::size_t>(t)];
        if (pocket >= 0) {
            mean[static_cast<std::size_t>(pocket)] += whole[static_cast<std::size_t>(t)];
        } else if (pocket == by_cell) {
            for_cut_cells(t, [&](std::size_t p, float v) { mean[p] += static_cast<double>(v); });
        }
    }
    for (std::size_t p = 0; p < mean.size(); ++p) mean[p] /= cells_[p];

    parallel_for(tiles, 16, [&](int t) {
        const int pocket = tile_pocket_[static_cast<std::size_t>(t)];
        if (pocket == by_cell) {
            for_cut_cells(t, [&](std::size_t p, float& v) { v -= static_cast<float>(mean[p]); });
        } else if (pocket >= 0) {
            const Vec3i size = level.map->cells_of(t).size();
            const auto m = static_cast<float>(mean[static_cast<std::size_t>(pocket)]);
            for (int k = 0; k < size.z; ++k) {
                for (int j = 0; j < size.y; ++j) {
                    for (int i = 0; i < size.x; ++i) {
                        tile_of(t)[index[level.shape().index(i, j, k)]] -= m;
                    }
                }
            }
        }
    });
}

}  // namespace gischt
