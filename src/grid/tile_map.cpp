// SPDX-License-Identifier: Apache-2.0
#include "grid/tile_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace gischt {

// Spreads the low 21 bits of x to every third bit.
static std::uint64_t spread_bits(std::uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x001f00000000ffffULL;
    x = (x | x << 16) & 0x001f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

// Morton code of coordinates in [-2^20, 2^20).
static std::uint64_t morton(const Vec3i& c) {
    const auto u = [](int a) { return static_cast<std::uint64_t>(a + (1 << 20)); };
    return spread_bits(u(c.x)) | spread_bits(u(c.y)) << 1 | spread_bits(u(c.z)) << 2;
}

TileMap::Ptr TileMap::box(const Vec3i& cells) {
    if (min_component(cells) < 1) {
        throw Error(ErrorKind::Usage, "grid",
                    fmt::format("a box of {} x {} x {} cells has none", cells.x, cells.y, cells.z));
    }
    const TileShape shape = cells.z == 1 ? tile_shape_2d : tile_shape_3d;
    const Vec3i n = shape.tile_of(cells - Vec3i(1)) + Vec3i(1);
    if (static_cast<double>(n.x) * n.y * n.z * tile_values > 2147483648.0) {
        throw Error(ErrorKind::Usage, "grid",
                    fmt::format("{} x {} x {} cells are more than 2^31", cells.x, cells.y, cells.z),
                    "lower the resolution");
    }
    std::vector<Vec3i> tiles;
    tiles.reserve(volume(n));
    for (int k = 0; k < n.z; ++k) {
        for (int j = 0; j < n.y; ++j) {
            for (int i = 0; i < n.x; ++i) tiles.emplace_back(i, j, k);
        }
    }
    return Ptr(new TileMap(std::move(tiles), {{}, cells}, shape, true));
}

TileMap::Ptr TileMap::sparse(std::vector<Vec3i> tiles, const Box3i& bounds, TileShape shape) {
    return Ptr(new TileMap(std::move(tiles), bounds, shape, false));
}

TileMap::TileMap(std::vector<Vec3i> tiles, const Box3i& bounds, TileShape shape, bool is_box)
    : shape_(shape), bounds_(bounds), is_box_(is_box), coord_(std::move(tiles)) {
    for (const Vec3i& c : coord_) {
        if (max_component(abs(c)) >= 1 << 20) {
            throw Error(ErrorKind::Input, "grid",
                        fmt::format("tile ({}, {}, {}) is more than 2^20 tiles from the origin",
                                    c.x, c.y, c.z));
        }
    }
    std::ranges::sort(coord_, {}, morton);
    coord_.erase(std::unique(coord_.begin(), coord_.end()), coord_.end());
    index_tiles();
    link_neighbours();
}

void TileMap::index_tiles() {
    table_box_ = Box3i::empty();
    for (const Vec3i& c : coord_) table_box_.extend(Box3i{c, c + Vec3i(1)});
    if (coord_.empty()) {
        table_box_ = {};
        return;
    }
    const Vec3d extent = Vec3d(table_box_.hi) - Vec3d(table_box_.lo);
    const double table_size = extent.x * extent.y * extent.z;
    // A table costs 4 bytes per possible tile; 64 times the tiles is an eighth of one float field.
    if (table_size <= 64.0 * static_cast<double>(coord_.size()) + 65536) {
        const Vec3i n = table_box_.size();
        table_.assign(volume(n), -1);
        for (int t = 0; t < size(); ++t) {
            const Vec3i c = coord(t) - table_box_.lo;
            table_[static_cast<std::size_t>(c.x) +
                   static_cast<std::size_t>(n.x) *
                       (static_cast<std::size_t>(c.y) +
                        static_cast<std::size_t>(n.y) * static_cast<std::size_t>(c.z))] = t;
        }
    } else {
        hash_.reserve(coord_.size());
        for (int t = 0; t < size(); ++t) hash_.emplace(morton(coord(t)), t);
    }
}

int TileMap::find(const Vec3i& tile_coord) const {
    if (!table_box_.contains(tile_coord)) return -1;
    if (!table_.empty()) {
        const Vec3i c = tile_coord - table_box_.lo, n = table_box_.size();
        return table_[static_cast<std::size_t>(c.x) +
                      static_cast<std::size_t>(n.x) *
                          (static_cast<std::size_t>(c.y) +
                           static_cast<std::size_t>(n.y) * static_cast<std::size_t>(c.z))];
    }
    const auto found = hash_.find(morton(tile_coord));
    return found == hash_.end() ? -1 : found->second;
}

void TileMap::link_neighbours() {
    neighbours_.resize(coord_.size());
    for (int t = 0; t < size(); ++t) {
        std::size_t n = 0;
        for (int dz = -1; dz <= 1; ++dz) {
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    neighbours_[static_cast<std::size_t>(t)][n++] =
                        find(coord(t) + Vec3i(dx, dy, dz));
                }
            }
        }
    }
}

}  // namespace gischt
