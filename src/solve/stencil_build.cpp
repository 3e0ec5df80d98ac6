// SPDX-License-Identifier: Apache-2.0
#include "solve/stencil_build.h"

#include <algorithm>
#include <cmath>

namespace gischt {
namespace {

// How the open box looks to the cells of one tile along one axis: the weight ratios of their lower
// and upper faces, and how much of each cell lies inside the box (a coarse one may hang over).
struct AxisTable {
    std::array<double, 32> lower{}, upper{}, cover{};
    bool is_plain = true;  // all 1

    AxisTable(const StencilLevel& level, int axis, int tile_coordinate) {
        const int n = level.cells[axis], width = level.shape().extent()[axis];
        // In 2-D nothing is coarsened along z.
        const double edge = axis < level.axes() ? std::ldexp(1.0, level.depth) : 1.0;
        for (int i = 0; i < width; ++i) {
            const int cell = tile_coordinate * width + i;
            const auto at = static_cast<std::size_t>(i);
            if (cell < n) {
                cover[at] = std::clamp(level.finest_cells[axis] / edge - cell, 0.0, 1.0);
                lower[at] = cell == 0 ? side_ratio(level, axis, 0) : 1.0;
                upper[at] = cell == n - 1 ? side_ratio(level, axis, 1) : 1.0;
            }
            is_plain = is_plain && lower[at] == 1 && upper[at] == 1 && cover[at] == 1;
        }
    }
};

// Kind of a tile along one axis: 0 plain, else 1 first, 2 last, 3 both.
int tile_kind(const StencilLevel& level, int axis, int tile_coordinate) {
    const int width = level.shape().extent()[axis];
    const bool first = tile_coordinate == 0;
    const bool last = (tile_coordinate + 1) * width >= level.cells[axis];
    if (!first && !last) return 0;
    return AxisTable(level, axis, tile_coordinate).is_plain ? 0 : (first ? 1 : 0) + (last ? 2 : 0);
}

// Coefficients of a tile of the open box at the given place.
void fill_open_block(const StencilLevel& level, const std::array<AxisTable, 3>& table,
                     StencilBlock& block) {
    const TileShape& shape = level.shape();
    for (int v = 0; v < tile_values; ++v) {
        const Vec3i c = shape.cell(v);
        double cover[3];
        for (int a = 0; a < 3; ++a) {
            cover[a] = table[static_cast<std::size_t>(a)].cover[static_cast<std::size_t>(c[a])];
        }
        const int at = split_index(shape, c), color = at / color_values, i = at % color_values;
        for (int a = 0; a < level.axes(); ++a) {
            const AxisTable& t = table[static_cast<std::size_t>(a)];
            const double area = cover[(a + 1) % 3] * cover[(a + 2) % 3] * level.weight;
            const auto along = static_cast<std::size_t>(c[a]);
            block.weight[color][direction_of(c, a, 0)][i] =
                static_cast<float>(t.lower[along] * area);
            block.weight[color][direction_of(c, a, 1)][i] =
                static_cast<float>(t.upper[along] * area);
        }
        block.extra[color][i] = static_cast<float>(level.shift * cover[0] * cover[1] * cover[2]);
    }
    finish_block(block, level.axes());
}

// Gives every tile the block of its kind; kinds that no tile has get no block.
void make_shared_blocks(StencilLevel& level) {
    const auto tiles = static_cast<std::size_t>(level.map->size());
    std::array<std::vector<int>, 3> kind;
    const Vec3i extent = level.shape().extent();
    for (int a = 0; a < 3; ++a) {
        for (int t = 0; t * extent[a] < level.cells[a]; ++t) {
            kind[static_cast<std::size_t>(a)].push_back(tile_kind(level, a, t));
        }
    }
    std::array<std::int32_t, 64> block_of_kind{};
    level.blocks.assign(2, StencilBlock{});
    level.block.assign(tiles, StencilLevel::constant_block);
    for (std::size_t t = 0; t < tiles; ++t) {
        const Vec3i& c = level.map->coord(static_cast<int>(t));
        std::size_t k = 0;
        for (int a = 2; a >= 0; --a) {
            k = 4 * k + static_cast<std::size_t>(
                            kind[static_cast<std::size_t>(a)][static_cast<std::size_t>(c[a])]);
        }
        if (k == 0) continue;
        if (block_of_kind[k] == 0) {
            block_of_kind[k] = static_cast<std::int32_t>(level.blocks.size());
            level.blocks.emplace_back();
            fill_open_block(
                level,
                {AxisTable(level, 0, c.x), AxisTable(level, 1, c.y), AxisTable(level, 2, c.z)},
                level.blocks.back());
        }
        level.block[t] = block_of_kind[k];
    }
    StencilBlock& constant = level.blocks[StencilLevel::constant_block];
    for (int color = 0; color < 2; ++color) {
        for (int a = 0; a < 2 * level.axes(); ++a) {
            std::fill_n(constant.weight[color][a], color_values, level.weight);
        }
        std::fill_n(constant.extra[color], color_values, static_cast<float>(level.shift));
    }
    finish_block(constant, level.axes());
    level.first_own_block = static_cast<int>(level.blocks.size());
}

// Value index of a cell in the level's fields.
std::int32_t value_index(const StencilLevel& level, const Vec3i& cell) {
    const Vec3i extent = level.shape().extent(), coord = level.shape().tile_of(cell);
    const Vec3i first{coord.x * extent.x, coord.y * extent.y, coord.z * extent.z};
    return level.map->find(coord) * tile_values + split_index(level.shape(), cell - first);
}

// Copies that continue a periodic axis whose extent is no multiple of the tile's: the plane past
// the last one inside the last tile, the plane before the first one in a ghost tile of its own.
void link_periodic(StencilLevel& level, int axis, int tile, int& ghost) {
    const int n = level.cells[axis], width = level.shape().extent()[axis];
    const Box3i inside = level.map->cells_of(tile);
    const bool first = inside.lo[axis] == 0, last = inside.hi[axis] == n;
    if (first)
        level.neighbours[static_cast<std::size_t>(tile)][2u * static_cast<unsigned>(axis)] = ghost;
    Box3i plane = inside;
    plane.hi[axis] = plane.lo[axis] + 1;
    for (int k = plane.lo.z; k < plane.hi.z; ++k) {
        for (int j = plane.lo.y; j < plane.hi.y; ++j) {
            for (int i = plane.lo.x; i < plane.hi.x; ++i) {
                Vec3i low{i, j, k}, high{i, j, k};
                low[axis] = 0;
                high[axis] = n - 1;
                if (last) {
                    Vec3i local = low - level.map->first_cell(tile);
                    local[axis] = n % width;
                    level.copies.push_back({tile * tile_values + split_index(level.shape(), local),
                                            value_index(level, low)});
                }
                if (first) {
                    Vec3i local = low - level.map->first_cell(tile);
                    local[axis] = width - 1;
                    level.copies.push_back({ghost * tile_values + split_index(level.shape(), local),
                                            value_index(level, high)});
                }
            }
        }
    }
    if (first) ++ghost;
}

void link_tiles(StencilLevel& level) {
    const TileMap& map = *level.map;
    const auto tiles = static_cast<std::size_t>(map.size());
    level.neighbours.assign(tiles, {-1, -1, -1, -1, -1, -1});
    int ghost = map.size();
    for (int t = 0; t < map.size(); ++t) {
        for (int a = 0; a < level.axes(); ++a) {
            const int n = level.cells[a], width = level.shape().extent()[a];
            for (int end = 0; end < 2; ++end) {
                Vec3i c = map.coord(t);
                c[a] += end == 0 ? -1 : 1;
                const bool wraps =
                    level.sides[static_cast<std::size_t>(2 * a)].kind == SideRule::Kind::Periodic &&
                    n % width == 0;
                const int count = (n + width - 1) / width;
                if (wraps) c[a] = (c[a] + count) % count;
                level.neighbours[static_cast<std::size_t>(t)]
                                [static_cast<std::size_t>(2 * a + end)] = map.find(c);
            }
            if (level.sides[static_cast<std::size_t>(2 * a)].kind == SideRule::Kind::Periodic &&
                n % width != 0) {
                link_periodic(level, a, t, ghost);
            }
        }
    }
    level.tiles_with_ghosts = ghost + 1;
    for (auto& n : level.neighbours) std::ranges::replace(n, -1, ghost);
}

}  // namespace

double side_ratio(const StencilLevel& level, int axis, int end) {
    const SideRule& side = level.sides[static_cast<std::size_t>(2 * axis + end)];
    if (side.kind == SideRule::Kind::Closed) return 0;
    if (side.kind == SideRule::Kind::Periodic) return 1;
    const double edge = std::ldexp(1.0, level.depth);
    const int cell = end == 0 ? 0 : level.cells[axis] - 1;
    const double inside = std::min(level.finest_cells[axis] - cell * edge, edge);
    return edge / (0.5 * inside - 0.5 + side.distance);
}

TileMap::Ptr full_map(const Vec3i& cells, const TileShape& shape) {
    const Vec3i count = shape.tile_of(cells - Vec3i(1)) + Vec3i(1);
    std::vector<Vec3i> tiles;
    tiles.reserve(volume(count));
    for (int k = 0; k < count.z; ++k) {
        for (int j = 0; j < count.y; ++j) {
            for (int i = 0; i < count.x; ++i) tiles.emplace_back(i, j, k);
        }
    }
    return TileMap::sparse(std::move(tiles), {{}, cells}, shape);
}

StencilLevel make_open_level(TileMap::Ptr map, const StencilSpec& spec, const Vec3i& finest_cells,
                             int depth) {
    StencilLevel level;
    level.map = std::move(map);
    level.cells = level.map->bounds().size();
    level.finest_cells = finest_cells;
    level.sides = spec.sides;
    level.depth = depth;
    level.shift = std::ldexp(spec.shift, depth * level.axes());
    level.weight = level.is_2d() ? 1.0f : std::ldexp(1.0f, depth);
    // A periodic axis of one cell couples it to itself: no flow at all.
    for (std::size_t a = 0; a < 3; ++a) {
        SideRule& low = level.sides[2 * a];
        if (level.cells[static_cast<int>(a)] == 1 && low.kind == SideRule::Kind::Periodic) {
            low.kind = level.sides[2 * a + 1].kind = SideRule::Kind::Closed;
        }
    }
    link_tiles(level);
    make_shared_blocks(level);
    return level;
}

void add_own_blocks(StencilLevel& level, const std::vector<char>& wanted) {
    auto next = static_cast<std::int32_t>(level.blocks.size());
    for (std::size_t t = 0; t < wanted.size(); ++t) {
        if (wanted[t] != 0) level.block[t] = next++;
    }
    level.blocks.resize(static_cast<std::size_t>(next));
}

void finish_block(StencilBlock& block, int axes) {
    for (int color = 0; color < 2; ++color) {
        for (int i = 0; i < color_values; ++i) {
            float diagonal = block.extra[color][i];
            for (int d = 0; d < 2 * axes; ++d) diagonal += block.weight[color][d][i];
            block.inverse_diagonal[color][i] = diagonal > 0 ? 1 / diagonal : 0.0f;
        }
    }
}

void list_active(StencilLevel& level) {
    level.active.clear();
    for (int t = 0; t < level.map->size(); ++t) {
        if (level.block[static_cast<std::size_t>(t)] != StencilLevel::closed_block) {
            level.active.push_back(t);
        }
    }
}

float face_weight(const StencilLevel& level, int tile, const Vec3i& local, int axis, int end) {
    const int at = split_index(level.shape(), local);
    return level.block_of(tile)
        .weight[at / color_values][direction_of(local, axis, end)][at % color_values];
}

void fill_ghosts(const StencilLevel& level, SplitField& field, bool only_red) {
    float* v = field.data();
    for (const auto& copy : level.copies) {
        const bool is_black = (copy.from & color_values) != 0;
        v[copy.to] = only_red && is_black ? 0.0f : v[copy.from];
    }
}

}  // namespace gischt
