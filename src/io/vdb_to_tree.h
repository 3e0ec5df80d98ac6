// SPDX-License-Identifier: Apache-2.0
#pragma once

// Tiles to trees of OpenVDB. Part of vdb.cpp, the one file of gischt that includes it.

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/job.h"
#include "base/parallel.h"
#include "grid/frame.h"

namespace gischt::vdb_detail {

// The transform that puts index (i,j,k) at the cell's centre, or at its lower corner.
inline openvdb::math::Transform::Ptr from_transform(const gischt::Transform& t, bool half_voxel) {
    const Vec3d at = half_voxel ? t.point(Vec3d(0.5)) : t.translation;
    const openvdb::Vec3d translation(at.x, at.y, at.z);
    const Vec3d scale{t.column[0].x, t.column[1].y, t.column[2].z};
    const bool is_straight = t.column[0] == Vec3d(scale.x, 0, 0) &&
                             t.column[1] == Vec3d(0, scale.y, 0) &&
                             t.column[2] == Vec3d(0, 0, scale.z);
    // The simplest kind of map, which is what other programs write and test for; by way of scales,
    // since the library's way from a matrix to a scale loses digits far from the origin.
    using openvdb::math::Transform;
    if (is_straight) {
        const auto out = Transform::createLinearTransform(scale.x);
        if (scale != Vec3d(scale.x)) {
            out->postScale(openvdb::Vec3d(1, scale.y / scale.x, scale.z / scale.x));
        }
        out->postTranslate(translation);
        return out;
    }
    openvdb::Mat4d m = openvdb::Mat4d::identity();  // of row vectors
    for (int r = 0; r < 4; ++r) {
        const Vec3d row = r < 3 ? t.column[static_cast<std::size_t>(r)] : at;
        for (int c = 0; c < 3; ++c) m(r, c) = row[c];
    }
    return Transform::createLinearTransform(m);
}

template <class V>
V value_at(const Field& field, const auto& get) {
    if constexpr (openvdb::VecTraits<V>::Size == 3) {
        return V(get(field.component[0]), get(field.component[1]), get(field.component[2]));
    } else {
        return static_cast<V>(get(field.component[0]));
    }
}

template <class V>
V background_of(const Field& field) {
    if constexpr (openvdb::VecTraits<V>::Size == 3) {
        return V(field.background[0], field.background[1], field.background[2]);
    } else {
        return static_cast<V>(field.background[0]);
    }
}

// Origins of the leafs that the field's tiles touch, each once.
inline std::vector<Vec3i> leaf_origins(const TileMap& map) {
    std::vector<Vec3i> out;
    const Vec3i n = map.shape().extent();
    for (int t = 0; t < map.size(); ++t) {
        const Vec3i first = map.first_cell(t);
        for (int j = 0; j < n.y; j += 8) {
            for (int i = 0; i < n.x; i += 8) {
                out.emplace_back(first.x + i, first.y + j, first.z & ~7);
            }
        }
    }
    if (map.shape() != tile_shape_3d) {  // several layers may share a leaf
        std::ranges::sort(out, [](const Vec3i& a, const Vec3i& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        });
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }
    return out;
}

// The leaf at `origin`, or nothing where all values are background. Active are the cells that
// differ from it, of a level set those of the narrow band. Cells beyond the map's bounds mean
// nothing and are background.
template <class Tree>
std::unique_ptr<typename Tree::LeafNodeType> make_leaf(const Field& field, const Vec3i& origin) {
    using Leaf = typename Tree::LeafNodeType;
    using V = typename Tree::ValueType;
    const V background = background_of<V>(field);
    const TileMap& map = field.map();
    const Box3i cells = intersection(Box3i{origin, origin + Vec3i(8)}, map.bounds());
    const int tile = map.shape() == tile_shape_3d ? map.find(map.shape().tile_of(origin)) : -1;
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z), background);
    bool is_needed = false;
    for (int k = cells.lo.z; k < cells.hi.z; ++k) {
        for (int j = cells.lo.y; j < cells.hi.y; ++j) {
            for (int i = cells.lo.x; i < cells.hi.x; ++i) {
                const Vec3i c{i, j, k}, d = c - origin;
                const V value = value_at<V>(field, [&](const TileField<float>& component) {
                    return tile < 0 ? component.get(c, 0)
                                    : component.tile(tile)[tile_shape_3d.index(d.x, d.y, d.z)];
                });
                if (value == background) continue;
                is_needed = true;
                const auto n = static_cast<openvdb::Index>(d.x << 6 | d.y << 3 | d.z);
                leaf->setValueOn(n, value);
                if constexpr (std::is_same_v<V, float>) {
                    const bool in_band = std::abs(value) < std::abs(background);
                    if (field.kind == FieldClass::LevelSet && !in_band) leaf->setValueOff(n);
                }
            }
        }
    }
    return is_needed ? std::move(leaf) : nullptr;
}

// Leafs are made in parallel and linked in order. The grid is made and pruned by the library's
// compiled code: instantiating Grid here would cost a minute of compilation.
template <class Grid>
openvdb::GridBase::Ptr to_tree(const Field& field, Job& job) {
    using Tree = typename Grid::TreeType;
    using Leaf = typename Tree::LeafNodeType;
    const std::vector<Vec3i> origins = leaf_origins(field.map());
    std::vector<std::unique_ptr<Leaf>> leafs(origins.size());
    parallel_for(static_cast<int>(origins.size()), 64, [&](int l) {
        const auto i = static_cast<std::size_t>(l);
        leafs[i] = make_leaf<Tree>(field, origins[i]);
    });
    job.check();
    openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(Grid::gridType());
    Tree& tree = static_cast<Grid&>(*grid).tree();
    tree.root().setBackground(background_of<typename Tree::ValueType>(field), false);
    for (auto& leaf : leafs) {
        if (leaf) tree.addLeaf(leaf.release());
    }
    grid->pruneGrid();  // uniform leafs become tiles
    return grid;
}

}  // namespace gischt::vdb_detail
