// SPDX-License-Identifier: Apache-2.0
#pragma once

// Trees of OpenVDB to tiles. Part of vdb.cpp, the one file of gischt that includes it.

#include <openvdb/openvdb.h>

#include <fmt/format.h>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "io/vdb.h"
#include "io/vdb_grid.h"

namespace gischt::vdb_detail {

inline Vec3i to_vec(const openvdb::Coord& c) {
    return {c.x(), c.y(), c.z()};
}

template <class V>
constexpr int components_of = openvdb::VecTraits<V>::Size;

template <class V>
float component_of(const V& value, int c) {
    if constexpr (components_of<V> == 3) {
        return static_cast<float>(value[c]);
    } else {
        return static_cast<float>(value);
    }
}

// OpenVDB's leaf runs z fastest.
constexpr unsigned leaf_offset(int i, int j, int k) {
    return static_cast<unsigned>(i << 6 | j << 3 | k);
}

// The 512 values of a leaf; a plain array where the library has one.
template <class Leaf>
auto values_of(const Leaf& leaf) {
    if constexpr (std::is_same_v<typename Leaf::ValueType, bool>) {
        return [&leaf](unsigned n) { return leaf.getValue(n); };
    } else {
        return [data = leaf.buffer().data()](unsigned n) -> const auto& {
            return data[n];
        };
    }
}

// TileMap's reach: 2^20 tiles from the origin.
constexpr int farthest_cell = 1 << 23;

inline void check_reach(const openvdb::Coord& c, const std::string& grid) {
    if (std::abs(std::int64_t{c.x()}) < farthest_cell &&
        std::abs(std::int64_t{c.y()}) < farthest_cell &&
        std::abs(std::int64_t{c.z()}) < farthest_cell) {
        return;
    }
    throw Error(ErrorKind::Input, grid,
                fmt::format("index ({}, {}, {}) is more than 2^23 cells from the origin", c.x(),
                            c.y(), c.z()));
}

// A box of equal values above the leafs.
template <class V>
struct Uniform {
    Box3i box;
    V value;
};

// Active tiles, and inactive ones that differ from the background (the inside of level sets).
template <class Tree>
auto uniform_tiles(const Tree& tree, const std::string& name) {
    std::vector<Uniform<typename Tree::ValueType>> out;
    auto it = tree.cbeginValueAll();
    it.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; it; ++it) {
        if (it.getValue() == tree.background()) continue;
        openvdb::CoordBBox box;
        it.getBoundingBox(box);
        check_reach(box.min(), name);
        check_reach(box.max(), name);
        out.push_back({{to_vec(box.min()), to_vec(box.max()) + Vec3i(1)}, it.getValue()});
    }
    return out;
}

// Cells of a leaf that are active or differ from the background.
template <class Leaf>
Box3i box_of_values(const Leaf& leaf, const typename Leaf::ValueType& background) {
    const Vec3i origin = to_vec(leaf.origin());
    if (leaf.isDense()) return {origin, origin + Vec3i(8)};
    const auto value = values_of(leaf);
    Box3i box = Box3i::empty();
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) {
            for (int k = 0; k < 8; ++k) {
                const unsigned n = leaf_offset(i, j, k);
                if (!leaf.isValueOn(n) && value(n) == background) continue;
                const Vec3i cell = origin + Vec3i(i, j, k);
                box.extend(Box3i{cell, cell + Vec3i(1)});
            }
        }
    }
    return box;
}

inline Transform to_transform(const openvdb::math::Transform& transform) {
    const openvdb::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();  // points are rows
    const auto row = [&](int r) { return Vec3d(m(r, 0), m(r, 1), m(r, 2)); };
    Transform out;
    out.column = {row(0), row(1), row(2)};
    out.translation = row(3) - 0.5 * (row(0) + row(1) + row(2));
    return out;
}

inline bool is_sound(const Transform& t) {
    const double d = t.determinant();
    return std::isfinite(d) && d != 0 && std::isfinite(dot(t.translation, t.translation));
}

// What all grids of one read share.
struct Reading {
    const std::string& path;
    const VdbReadOptions& options;
    Job& job;
    std::atomic<std::int64_t> values{0};  // claimed so far

    void claim(const std::string& grid, double tiles, int components) {
        const double wanted = tiles * tile_values * components;
        const double limit = static_cast<double>(options.max_values);
        const double total = wanted > limit
                                 ? wanted
                                 : static_cast<double>(values += static_cast<std::int64_t>(wanted));
        if (total > limit) {
            throw Error(ErrorKind::Resource, path,
                        fmt::format("grid '{}' spells out to {:.3g} values, more than the limit "
                                    "of {:.3g}",
                                    grid, total, limit),
                        "read fewer grids, or raise the limit");
        }
    }
};

// Fills a tile from a leaf; counts what is not finite.
template <class Leaf>
std::int64_t copy_leaf(const Leaf& leaf, int t, Field& field) {
    const auto value = values_of(leaf);
    std::int64_t bad = 0;
    for (std::size_t c = 0; c < field.component.size(); ++c) {
        float* out = field.component[c].tile(t);
        for (int k = 0; k < 8; ++k) {
            for (int j = 0; j < 8; ++j) {
                for (int i = 0; i < 8; ++i, ++out) {
                    const auto& v = value(leaf_offset(i, j, k));
                    *out = component_of(v, static_cast<int>(c));
                    if (std::isfinite(*out)) continue;
                    *out = field.background[c];
                    ++bad;
                }
            }
        }
    }
    return bad;
}

// The same for the layer k = 0 of a leaf and 2-D tiles, 32 x 16 cells.
template <class Leaf>
std::int64_t copy_layer(const Leaf& leaf, Field& field) {
    const auto value = values_of(leaf);
    const Vec3i origin = to_vec(leaf.origin());
    std::int64_t bad = 0;
    for (std::size_t c = 0; c < field.component.size(); ++c) {
        for (int j = 0; j < 8; ++j) {
            for (int i = 0; i < 8; ++i) {
                const auto& v = value(leaf_offset(i, j, 0));
                const float number = component_of(v, static_cast<int>(c));
                const bool good = std::isfinite(number);
                field.component[c].ref(origin + Vec3i(i, j, 0)) =
                    good ? number : field.background[c];
                bad += !good;
            }
        }
    }
    return bad;
}

// Box of a metadatum pair that gischt writes, if it is there and holds `values`.
inline Box3i stated_bounds(const std::map<std::string, std::string>& metadata,
                           const Box3i& values) {
    Box3i box{};
    const auto lo = metadata.find("gischt_bounds_min"), hi = metadata.find("gischt_bounds_max");
    if (lo == metadata.end() || hi == metadata.end()) return values;
    const auto parse = [](const std::string& s, Vec3i& v) {
        return std::sscanf(s.c_str(), "%d %d %d", &v.x, &v.y, &v.z) == 3;
    };
    if (!parse(lo->second, box.lo) || !parse(hi->second, box.hi)) return values;
    return values.is_empty() || intersection(box, values) == values ? box : values;
}

// All tiles that the leafs and uniform boxes cover.
template <class Leafs, class Uniforms>
std::vector<Vec3i> tiles_of(const Leafs& leafs, const Uniforms& uniform, const TileShape& shape) {
    std::vector<Vec3i> tiles;
    tiles.reserve(leafs.size());
    for (const auto* leaf : leafs) tiles.push_back(shape.tile_of(to_vec(leaf->origin())));
    for (const auto& u : uniform) {
        const Vec3i lo = shape.tile_of(u.box.lo), hi = shape.tile_of(u.box.hi - Vec3i(1));
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                for (int i = lo.x; i <= hi.x; ++i) tiles.emplace_back(i, j, k);
            }
        }
    }
    return tiles;
}

template <class V>
void fill_uniform(const Uniform<V>& uniform, VdbGrid& out) {
    Field& field = out.field;
    const TileMap& map = field.map();
    const Vec3i lo = map.shape().tile_of(uniform.box.lo);
    const Vec3i n = map.shape().tile_of(uniform.box.hi - Vec3i(1)) - lo + Vec3i(1);
    for (std::size_t c = 0; c < field.component.size(); ++c) {
        float number = component_of(uniform.value, static_cast<int>(c));
        if (!std::isfinite(number)) {
            out.bad_values += static_cast<std::int64_t>(volume(uniform.box.size()));
            number = field.background[c];
        }
        parallel_for(static_cast<int>(volume(n)), 64, [&](int m) {
            const int t = map.find(lo + Vec3i(m % n.x, m / n.x % n.y, m / n.x / n.y));
            std::fill_n(field.component[c].tile(t), tile_values, number);
        });
    }
}

template <class Tree>
void set_background(const Tree& tree, VdbGrid& out) {
    out.field.background = {};
    for (int c = 0; c < components_of<typename Tree::ValueType>; ++c) {
        const float number = component_of(tree.background(), c);
        if (std::isfinite(number)) {
            out.field.background[static_cast<std::size_t>(c)] = number;
        } else {
            ++out.bad_values;
        }
    }
}

template <class Grid>
void to_tiles(const Grid& grid, Reading& reading, VdbGrid& out) {
    using Tree = typename Grid::TreeType;
    using Value = typename Tree::ValueType;
    const Tree& tree = grid.tree();
    std::vector<const typename Tree::LeafNodeType*> leafs;
    tree.getNodes(leafs);
    for (const auto* leaf : leafs) check_reach(leaf->origin(), out.name);
    const auto uniform = uniform_tiles(tree, out.name);
    double tiles = static_cast<double>(leafs.size());
    for (const auto& u : uniform) {
        const Vec3d n(u.box.size());
        tiles += n.x * n.y * n.z / tile_values;
    }
    reading.claim(out.name, tiles, components_of<Value>);

    // Which cells may hold values; for staggered vectors also the ones whose upper faces do.
    const int leaf_count = static_cast<int>(leafs.size());
    std::vector<Box3i> boxes(leafs.size());
    parallel_for(leaf_count, 64, [&](int l) {
        const auto i = static_cast<std::size_t>(l);
        boxes[i] = box_of_values(*leafs[i], tree.background());
    });
    Box3i bounds = Box3i::empty();
    for (const Box3i& b : boxes) bounds.extend(b);
    for (const auto& u : uniform) bounds.extend(u.box);
    const bool is_layer = out.metadata.contains("gischt_2d") && uniform.empty() &&
                          (bounds.is_empty() || (bounds.lo.z == 0 && bounds.hi.z == 1));
    if (out.is_staggered && !bounds.is_empty()) bounds.lo -= Vec3i(1);
    bounds =
        bounds.is_empty() ? stated_bounds(out.metadata, {}) : stated_bounds(out.metadata, bounds);

    // Tiles, leafs one to one, then the uniform boxes.
    const TileShape shape = is_layer ? tile_shape_2d : tile_shape_3d;
    const auto map = TileMap::sparse(tiles_of(leafs, uniform, shape), bounds, shape);
    set_background(tree, out);
    for (int c = 0; c < components_of<Value>; ++c) {
        out.field.component.emplace_back(map, out.field.background[static_cast<std::size_t>(c)]);
    }
    std::atomic<std::int64_t> bad{0};
    parallel_for(leaf_count, 16, [&](int l) {
        const auto& leaf = *leafs[static_cast<std::size_t>(l)];
        const Vec3i origin = to_vec(leaf.origin());
        if (is_layer) {
            if (origin.z == 0) bad += copy_layer(leaf, out.field);
        } else {
            bad += copy_leaf(leaf, map->find(shape.tile_of(origin)), out.field);
        }
    });
    for (const auto& u : uniform) fill_uniform(u, out);
    out.bad_values += bad;
}

}  // namespace gischt::vdb_detail
