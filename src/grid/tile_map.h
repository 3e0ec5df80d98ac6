// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "math/box.h"
#include "math/vec.h"

namespace gischt {

inline constexpr int tile_values = 512;

// Extent of a tile in cells, powers of two whose product is tile_values. Inside a tile x runs
// fastest, then y, then z.
struct TileShape {
    int log_x, log_y, log_z;

    constexpr Vec3i extent() const { return {1 << log_x, 1 << log_y, 1 << log_z}; }
    constexpr int index(int i, int j, int k) const { return i + ((j + (k << log_y)) << log_x); }
    constexpr Vec3i cell(int index) const {
        return {index & ((1 << log_x) - 1), index >> log_x & ((1 << log_y) - 1),
                index >> (log_x + log_y)};
    }
    // Tile coordinates of a cell, also for negative cells.
    constexpr Vec3i tile_of(const Vec3i& c) const {
        return {c.x >> log_x, c.y >> log_y, c.z >> log_z};
    }
    constexpr bool operator==(const TileShape&) const = default;
};

inline constexpr TileShape tile_shape_3d{3, 3, 3};  // 8 x 8 x 8
inline constexpr TileShape tile_shape_2d{5, 4, 0};  // 32 x 16 x 1

// Topology of a domain: which tiles exist, from tile coordinates to a dense index in Morton order,
// and the neighbours of each. Immutable; shared by all fields of the domain.
class TileMap {
  public:
    using Ptr = std::shared_ptr<const TileMap>;

    // All tiles of the box of cells [0, cells). 2-D (32x16x1 tiles) where cells.z is 1. Where an
    // extent is not a multiple of the tile's, the last tiles hang over: their outer values mean
    // nothing and are kept at zero. Throws Error{Usage} on a count below 1 or above 2^31 values.
    static Ptr box(const Vec3i& cells);
    // The given tiles, in any order, duplicates allowed. `bounds`: the cells that may hold values.
    static Ptr sparse(std::vector<Vec3i> tiles, const Box3i& bounds,
                      TileShape shape = tile_shape_3d);

    const TileShape& shape() const { return shape_; }
    int size() const { return static_cast<int>(coord_.size()); }
    // The cells that carry meaning; a box map's is [0, cells).
    const Box3i& bounds() const { return bounds_; }
    bool is_box() const { return is_box_; }
    bool is_2d() const { return shape_ == tile_shape_2d; }

    const Vec3i& coord(int tile) const { return coord_[static_cast<std::size_t>(tile)]; }
    Vec3i first_cell(int tile) const {
        const Vec3i& c = coord(tile);
        return {c.x << shape_.log_x, c.y << shape_.log_y, c.z << shape_.log_z};
    }
    // The tile's cells inside bounds(); equal to the whole tile for all but overhanging ones.
    Box3i cells_of(int tile) const {
        const Vec3i lo = first_cell(tile);
        return intersection(Box3i{lo, lo + shape_.extent()}, bounds_);
    }
    // Index of the tile at these tile coordinates, or -1.
    int find(const Vec3i& tile_coord) const;
    // Neighbour by offset, each of -1, 0, 1; -1 where there is none. Periodic domains do not wrap
    // here.
    int neighbour(int tile, int dx, int dy, int dz) const {
        return neighbours(tile)[static_cast<std::size_t>(dx + 1 + 3 * (dy + 1) + 9 * (dz + 1))];
    }
    // All 27, x fastest; entry 13 is the tile itself.
    const std::array<std::int32_t, 27>& neighbours(int tile) const {
        return neighbours_[static_cast<std::size_t>(tile)];
    }

  private:
    TileMap(std::vector<Vec3i> tiles, const Box3i& bounds, TileShape shape, bool is_box);
    void index_tiles();
    void link_neighbours();

    TileShape shape_;
    Box3i bounds_;
    bool is_box_;
    std::vector<Vec3i> coord_;
    std::vector<std::array<std::int32_t, 27>> neighbours_;
    // Look-up: a table over the box of tile coordinates where that is small enough, else a hash
    // map.
    Box3i table_box_;
    std::vector<std::int32_t> table_;
    std::unordered_map<std::uint64_t, std::int32_t> hash_;
};

}  // namespace gischt
