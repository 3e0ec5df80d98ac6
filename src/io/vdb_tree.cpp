// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"

namespace gischt {

namespace {

// OpenVDB's leaf runs z fastest.
constexpr int leaf_offset(int i, int j, int k) {
    return i << 6 | j << 3 | k;
}
constexpr Vec3i leaf_cell(int n) {
    return {n >> 6, n >> 3 & 7, n & 7};
}

bool is_on(const std::uint64_t* bits, int n) {
    return (bits[n >> 6] >> (n & 63) & 1) != 0;
}

// Calls f(value) with value(leaf, n, c) -> float, component c of value n, for the tree's scalar.
template <class F>
void with_values(const VdbTree& tree, F&& f) {
    const auto as = [&]<class T>(const T*) {
        f([components = tree.components](const VdbLeaf& leaf, int n, int c) {
            return static_cast<float>(static_cast<const T*>(leaf.values)[n * components + c]);
        });
    };
    switch (tree.scalar) {
        case VdbScalar::Float:
            return as(static_cast<float*>(nullptr));
        case VdbScalar::Double:
            return as(static_cast<double*>(nullptr));
        case VdbScalar::Int32:
            return as(static_cast<std::int32_t*>(nullptr));
        case VdbScalar::Int64:
            return as(static_cast<std::int64_t*>(nullptr));
        case VdbScalar::Bit:
            return f([](const VdbLeaf& leaf, int n, int) {
                const auto* bits = static_cast<const std::uint64_t*>(leaf.values);
                return is_on(bits ? bits : leaf.active.data(), n) ? 1.0f : 0.0f;
            });
    }
}

float background_of(const VdbTree& tree, int c) {
    return static_cast<float>(tree.background[static_cast<std::size_t>(c)]);
}

// Cells of a leaf that are active or differ from the background.
Box3i box_of_values(const VdbTree& tree, const VdbLeaf& leaf, const auto& value) {
    const bool is_full =
        std::ranges::all_of(leaf.active, [](std::uint64_t w) { return w == ~std::uint64_t{0}; });
    if (is_full) return {leaf.origin, leaf.origin + Vec3i(8)};
    Box3i box = Box3i::empty();
    for (int n = 0; n < tile_values; ++n) {
        bool counts = is_on(leaf.active.data(), n);
        for (int c = 0; c < tree.components && !counts; ++c) {
            counts = value(leaf, n, c) != background_of(tree, c);
        }
        if (!counts) continue;
        const Vec3i cell = leaf.origin + leaf_cell(n);
        box.extend(Box3i{cell, cell + Vec3i(1)});
    }
    return box;
}

Box3i box_of_values(const VdbTree& tree) {
    std::vector<Box3i> boxes(tree.leafs.size());
    with_values(tree, [&](const auto& value) {
        parallel_for(static_cast<int>(boxes.size()), 64, [&](int l) {
            const auto i = static_cast<std::size_t>(l);
            boxes[i] = box_of_values(tree, tree.leafs[i], value);
        });
    });
    Box3i box = Box3i::empty();
    for (const Box3i& b : boxes) box.extend(b);
    for (const VdbTile& t : tree.tiles) box.extend(t.box);
    return box;
}

// The bounds that gischt writes as metadata, if they are there and hold `values`.
Box3i stated_bounds(const std::map<std::string, std::string>& metadata, const Box3i& values) {
    Box3i box{};
    const auto lo = metadata.find("gischt_bounds_min"), hi = metadata.find("gischt_bounds_max");
    if (lo == metadata.end() || hi == metadata.end()) return values;
    const auto parse = [](const std::string& s, Vec3i& v) {
        return std::sscanf(s.c_str(), "%d %d %d", &v.x, &v.y, &v.z) == 3;
    };
    if (!parse(lo->second, box.lo) || !parse(hi->second, box.hi)) return values;
    return values.is_empty() || intersection(box, values) == values ? box : values;
}

// Tile coordinates that a box of cells covers, half-open.
Box3i tile_box(const TileShape& shape, const Box3i& box) {
    return {shape.tile_of(box.lo), shape.tile_of(box.hi - Vec3i(1)) + Vec3i(1)};
}

std::vector<Vec3i> tiles_of(const VdbTree& tree, const TileShape& shape) {
    std::vector<Vec3i> out;
    out.reserve(tree.leafs.size());
    for (const VdbLeaf& leaf : tree.leafs) out.push_back(shape.tile_of(leaf.origin));
    for (const VdbTile& tile : tree.tiles) {
        const Box3i b = tile_box(shape, tile.box);
        for (int k = b.lo.z; k < b.hi.z; ++k) {
            for (int j = b.lo.y; j < b.hi.y; ++j) {
                for (int i = b.lo.x; i < b.hi.x; ++i) out.emplace_back(i, j, k);
            }
        }
    }
    return out;
}

// A finite number, or the background and one more in `bad`.
float checked(float number, float background, std::int64_t& bad) {
    if (std::isfinite(number)) return number;
    ++bad;
    return background;
}

std::int64_t copy_leaf(const VdbLeaf& leaf, int t, Field& field, const auto& value) {
    std::int64_t bad = 0;
    for (int c = 0; c < static_cast<int>(field.component.size()); ++c) {
        const auto axis = static_cast<std::size_t>(c);
        float* out = field.component[axis].tile(t);
        for (int k = 0; k < 8; ++k) {
            for (int j = 0; j < 8; ++j) {
                for (int i = 0; i < 8; ++i) {
                    *out++ =
                        checked(value(leaf, leaf_offset(i, j, k), c), field.background[axis], bad);
                }
            }
        }
    }
    return bad;
}

// The same for the layer k = 0 of a leaf and 2-D tiles, 32 x 16 cells.
std::int64_t copy_layer(const VdbLeaf& leaf, Field& field, const auto& value) {
    std::int64_t bad = 0;
    for (int c = 0; c < static_cast<int>(field.component.size()); ++c) {
        const auto axis = static_cast<std::size_t>(c);
        for (int j = 0; j < 8; ++j) {
            for (int i = 0; i < 8; ++i) {
                field.component[axis].ref(leaf.origin + Vec3i(i, j, 0)) =
                    checked(value(leaf, leaf_offset(i, j, 0), c), field.background[axis], bad);
            }
        }
    }
    return bad;
}

void fill_tile(const VdbTile& tile, VdbGrid& out) {
    const TileMap& map = out.field.map();
    const Box3i box = tile_box(map.shape(), tile.box);
    const Vec3i n = box.size();
    for (std::size_t c = 0; c < out.field.component.size(); ++c) {
        std::int64_t bad = 0;
        const float number =
            checked(static_cast<float>(tile.value[c]), out.field.background[c], bad);
        out.bad_values += bad * static_cast<std::int64_t>(volume(tile.box.size()));
        parallel_for(static_cast<int>(volume(n)), 64, [&](int m) {
            const int t = map.find(box.lo + Vec3i(m % n.x, m / n.x % n.y, m / n.x / n.y));
            std::fill_n(out.field.component[c].tile(t), tile_values, number);
        });
    }
}

void copy_values(const VdbTree& tree, VdbGrid& out) {
    const TileMap& map = out.field.map();
    std::atomic<std::int64_t> bad{0};
    with_values(tree, [&](const auto& value) {
        parallel_for(static_cast<int>(tree.leafs.size()), 16, [&](int l) {
            const VdbLeaf& leaf = tree.leafs[static_cast<std::size_t>(l)];
            if (map.is_2d()) {
                if (leaf.origin.z == 0) bad += copy_layer(leaf, out.field, value);
            } else {
                bad +=
                    copy_leaf(leaf, map.find(map.shape().tile_of(leaf.origin)), out.field, value);
            }
        });
    });
    for (const VdbTile& tile : tree.tiles) fill_tile(tile, out);
    out.bad_values += bad;
}

struct Range {
    double min = std::numeric_limits<double>::infinity(), max = -min;

    // Of the length of a vector of finite numbers.
    void extend(const std::array<double, 3>& v) {
        const double x = v[1] == 0 && v[2] == 0 ? v[0] : std::hypot(v[0], v[1], v[2]);
        if (!std::isfinite(x)) return;
        min = std::min(min, x);
        max = std::max(max, x);
    }
};

}  // namespace

void VdbBudget::claim(const std::string& grid, double values) {
    const double most = static_cast<double>(limit);
    const double total =
        values > most ? values : static_cast<double>(claimed += static_cast<std::int64_t>(values));
    if (total <= most) return;
    throw Error(ErrorKind::Resource, path,
                fmt::format("grid '{}' spells out to {:.3g} values, more than the limit of {:.3g}",
                            grid, total, most),
                "read fewer grids, or raise the limit");
}

void check_reach(const Vec3i& cell, const std::string& grid) {
    constexpr int farthest = 1 << 23;
    const auto is_near = [](int c) { return c > -farthest && c < farthest; };
    if (is_near(cell.x) && is_near(cell.y) && is_near(cell.z)) return;
    throw Error(ErrorKind::Input, grid,
                fmt::format("index ({}, {}, {}) is more than 2^23 cells from the origin", cell.x,
                            cell.y, cell.z));
}

void tree_to_field(const VdbTree& tree, VdbBudget& budget, VdbGrid& out) {
    double tiles = static_cast<double>(tree.leafs.size());
    for (const VdbTile& t : tree.tiles) {
        const Vec3d n(t.box.size());
        tiles += n.x * n.y * n.z / tile_values;
    }
    budget.claim(out.name, tiles * tile_values * tree.components);

    // Which cells may hold values; for staggered vectors also the ones whose upper faces do.
    Box3i bounds = box_of_values(tree);
    const bool is_layer = out.metadata.contains("gischt_2d") && tree.tiles.empty() &&
                          (bounds.is_empty() || (bounds.lo.z == 0 && bounds.hi.z == 1));
    if (bounds.is_empty()) bounds = {};
    if (out.is_staggered) bounds.lo -= Vec3i(1);
    bounds = stated_bounds(out.metadata, bounds);

    const TileShape shape = is_layer ? tile_shape_2d : tile_shape_3d;
    const auto map = TileMap::sparse(tiles_of(tree, shape), bounds, shape);
    for (int c = 0; c < tree.components; ++c) {
        const auto i = static_cast<std::size_t>(c);
        out.field.background[i] = checked(background_of(tree, c), 0, out.bad_values);
        out.field.component.emplace_back(map, out.field.background[i]);
    }
    copy_values(tree, out);
}

void describe_tree(const VdbTree& tree, VdbGridInfo& info) {
    Box3i box = Box3i::empty();
    Range range;
    const auto add = [&](const Box3i& cells, const std::array<double, 3>& value) {
        info.active_voxels += std::int64_t{cells.size().x} * cells.size().y * cells.size().z;
        box.extend(cells);
        range.extend(value);
    };
    for (const VdbTile& tile : tree.tiles) {
        if (tile.is_active) add(tile.box, tile.value);
    }
    with_values(tree, [&](const auto& value) {
        for (const VdbLeaf& leaf : tree.leafs) {
            for (int n = 0; n < tile_values; ++n) {
                if (!is_on(leaf.active.data(), n)) continue;
                std::array<double, 3> v{};
                for (int c = 0; c < tree.components; ++c) {
                    v[static_cast<std::size_t>(c)] = value(leaf, n, c);
                }
                const Vec3i cell = leaf.origin + leaf_cell(n);
                add({cell, cell + Vec3i(1)}, v);
            }
        }
    });
    if (info.active_voxels > 0) {
        info.lo = {box.lo.x, box.lo.y, box.lo.z};
        info.hi = {box.hi.x - 1, box.hi.y - 1, box.hi.z - 1};
    }
    if (range.min <= range.max) {
        info.min = range.min;
        info.max = range.max;
    }
}

}  // namespace gischt
