// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "io/vdb.h"
#include "io/vdb_grid.h"

namespace gischt {

// A tree of OpenVDB as it lies in the library's memory, but without the library's types: what is
// compiled once instead of once per value type. Leafs are 8^3 cells, z fastest.
struct VdbLeaf {
    Vec3i origin;
    std::array<std::uint64_t, 8> active{};  // a bit per cell
    // 512 times `components` scalars, or 512 bits; null for a mask, whose values are `active`.
    const void* values = nullptr;
};

// A box of equal values above the leafs.
struct VdbTile {
    Box3i box;
    std::array<double, 3> value;
    bool is_active;
};

enum class VdbScalar { Float, Double, Int32, Int64, Bit };

struct VdbTree {
    VdbScalar scalar = VdbScalar::Float;
    int components = 1;
    std::array<double, 3> background{};
    std::vector<VdbLeaf> leafs;
    std::vector<VdbTile> tiles;  // active, or other than the background (the inside of level sets)
};

// The values that the grids of one file may spell out, together.
struct VdbBudget {
    std::string path;  // for the error
    std::int64_t limit = 0;
    std::atomic<std::int64_t> claimed{0};

    // Throws Error{Resource} when the limit is passed.
    void claim(const std::string& grid, double values);
};

// Throws Error{Input, `grid`} when a cell is beyond TileMap's reach of 2^23 cells from the origin.
void check_reach(const Vec3i& cell, const std::string& grid);

// Fills out.field's components, background and bounds, and counts out.bad_values: leafs become
// tiles one to one, uniform boxes are spelled out. Reads out.name, out.metadata, out.is_staggered.
void tree_to_field(const VdbTree& tree, VdbBudget& budget, VdbGrid& out);

// Active voxels, their box and the range of their values.
void describe_tree(const VdbTree& tree, VdbGridInfo& info);

}  // namespace gischt
