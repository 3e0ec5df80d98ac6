// SPDX-License-Identifier: Apache-2.0
#include "solve/stencil.h"

#include <algorithm>

#include "base/parallel.h"
#include "solve/stencil_build.h"

namespace gischt {
namespace {

constexpr int tile_grain = 16;

// True where all values of a tile's cells inside the box are v.
bool all_equal(const TileField<float>& field, int tile, float v) {
    const TileMap& map = field.map();
    const Box3i cells = map.cells_of(tile);
    const Vec3i size = cells.size();
    const float* values = field.tile(tile);
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; ++j) {
            const float* row = values + map.shape().index(0, j, k);
            for (int i = 0; i < size.x; ++i) {
                if (row[i] != v) return false;
            }
        }
    }
    return true;
}

bool wraps(const StencilLevel& level, int axis) {
    return level.sides[static_cast<std::size_t>(2 * axis)].kind == SideRule::Kind::Periodic;
}

// Tiles on whose faces everything is open for sure: their own lower faces, those of the tiles after
// them, whose first ones are their upper faces, and the last faces of the box or, on a periodic
// axis, the first ones again.
std::vector<char> open_tiles(const StencilLevel& level, const FaceField& fraction) {
    const TileMap& map = fraction.map();
    const int tiles = map.size();
    std::vector<char> lower(static_cast<std::size_t>(tiles)), open = lower;
    parallel_for(tiles, tile_grain, [&](int t) {
        bool all = true;
        for (int a = 0; all && a < fraction.axes(); ++a) all = all_equal(fraction[a], t, 1.0f);
        lower[static_cast<std::size_t>(t)] = all;
    });
    std::array<bool, 3> last_open{true, true, true};
    for (std::size_t a = 0; a < 3; ++a) {
        last_open[a] = std::ranges::all_of(fraction.last[a], [](float f) { return f == 1.0f; });
    }
    for (int t = 0; t < tiles; ++t) {
        bool all = lower[static_cast<std::size_t>(t)] != 0;
        for (int a = 0; a < fraction.axes(); ++a) {
            int next = map.neighbour(t, a == 0, a == 1, a == 2);
            if (next < 0 && wraps(level, a)) {
                Vec3i first = map.coord(t);
                first[a] = 0;
                next = map.find(first);
            }
            all = all && (next < 0 ? last_open[static_cast<std::size_t>(a)]
                                   : lower[static_cast<std::size_t>(next)] != 0);
        }
        open[static_cast<std::size_t>(t)] = all;
    }
    return open;
}

// Multiplies the box's weights, which the block holds, by the face fractions. Face n of a periodic
// axis is face 0.
void apply_fractions(const StencilLevel& level, const FaceField& fraction, int tile,
                     StencilBlock& block) {
    const TileMap& map = *level.map;
    const Box3i cells = map.cells_of(tile);
    const Vec3i first = map.first_cell(tile), size = cells.size(), extent = map.shape().extent();
    for (int a = 0; a < level.axes(); ++a) {
        const int next = map.neighbour(tile, a == 0, a == 1, a == 2);
        for (int v = 0; v < tile_values; ++v) {
            const Vec3i c = map.shape().cell(v);
            if (c.x >= size.x || c.y >= size.y || c.z >= size.z) continue;
            Vec3i up = c;
            up[a] += 1;
            float upper;
            if (first[a] + up[a] == level.cells[a]) {
                Vec3i face = first + up;
                if (wraps(level, a)) face[a] = 0;
                upper = fraction.get(a, face);
            } else if (up[a] < extent[a]) {
                upper = fraction[a].tile(tile)[map.shape().index(up.x, up.y, up.z)];
            } else {
                up[a] = 0;
                upper = fraction[a].tile(next)[map.shape().index(up.x, up.y, up.z)];
            }
            const int at = split_index(map.shape(), c), color = at / color_values;
            auto& weight = block.weight[color];
            weight[direction_of(c, a, 0)][at % color_values] *= fraction[a].tile(tile)[v];
            weight[direction_of(c, a, 1)][at % color_values] *= upper;
        }
    }
}

void add_extra(const TileField<float>& extra, int tile, StencilBlock& block) {
    const TileShape& shape = extra.map().shape();
    for (int v = 0; v < tile_values; ++v) {
        const int at = split_index(shape, shape.cell(v));
        block.extra[at / color_values][at % color_values] += extra.tile(tile)[v];
    }
}

void check(const StencilSpec& spec) {
    for (std::size_t a = 0; a < (spec.map->is_2d() ? 2 : 3); ++a) {
        if ((spec.sides[2 * a].kind == SideRule::Kind::Periodic) !=
            (spec.sides[2 * a + 1].kind == SideRule::Kind::Periodic)) {
            throw Error(ErrorKind::Usage, "solve",
                        std::string("only one of the two sides along ") + "xyz"[a] + " is periodic",
                        "make both of them periodic");
        }
    }
}

bool is_closed(const StencilBlock& block) {
    for (const auto& color : block.inverse_diagonal) {
        for (const float d : color) {
            if (d > 0) return false;
        }
    }
    return true;
}

}  // namespace

StencilLevel make_finest(const StencilSpec& spec) {
    check(spec);
    StencilLevel level = make_open_level(spec.map, spec, spec.map->bounds().size(), 0);
    if (spec.fraction != nullptr || spec.extra != nullptr) {
        const auto tiles = static_cast<std::size_t>(spec.map->size());
        std::vector<char> own(tiles, 0);
        if (spec.fraction != nullptr) {
            const std::vector<char> open = open_tiles(level, *spec.fraction);
            for (std::size_t t = 0; t < tiles; ++t) own[t] = open[t] == 0;
        }
        for (std::size_t t = 0; spec.extra != nullptr && t < tiles; ++t) {
            own[t] = own[t] != 0 || !all_equal(*spec.extra, static_cast<int>(t), 0.0f);
        }
        const std::vector<std::int32_t> shared = level.block;
        add_own_blocks(level, own);
        parallel_for(spec.map->size(), tile_grain, [&](int t) {
            if (!level.is_own(t)) return;
            auto& id = level.block[static_cast<std::size_t>(t)];
            StencilBlock& block = level.blocks[static_cast<std::size_t>(id)];
            block = level.blocks[static_cast<std::size_t>(shared[static_cast<std::size_t>(t)])];
            if (spec.fraction != nullptr) apply_fractions(level, *spec.fraction, t, block);
            if (spec.extra != nullptr) add_extra(*spec.extra, t, block);
            finish_block(block, level.axes());
            if (is_closed(block)) id = StencilLevel::closed_block;
        });
    }
    list_active(level);
    return level;
}

}  // namespace gischt
