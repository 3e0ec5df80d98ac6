// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's trees as VdbTree. Part of vdb.cpp, the one file of gischt that includes the library.

#include <openvdb/openvdb.h>

#include <string>

#include "io/vdb_tree.h"
#include "math/transform.h"

namespace gischt::vdb_detail {

inline Vec3i to_vec(const openvdb::Coord& c) {
    return {c.x(), c.y(), c.z()};
}

// Where index (i,j,k) is a cell's centre.
inline Transform to_transform(const openvdb::math::Transform& transform) {
    const openvdb::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();  // points are rows
    const auto row = [&](int r) { return Vec3d(m(r, 0), m(r, 1), m(r, 2)); };
    Transform out;
    out.column = {row(0), row(1), row(2)};
    out.translation = row(3) - 0.5 * (row(0) + row(1) + row(2));
    return out;
}

template <class V>
std::array<double, 3> numbers_of(const V& value) {
    if constexpr (openvdb::VecTraits<V>::Size == 3) {
        return {static_cast<double>(value[0]), static_cast<double>(value[1]),
                static_cast<double>(value[2])};
    } else {
        return {static_cast<double>(value), 0, 0};
    }
}

template <class V>
constexpr VdbScalar scalar_of() {
    using S = typename openvdb::VecTraits<V>::ElementType;
    if constexpr (std::is_same_v<S, bool>) return VdbScalar::Bit;
    if constexpr (std::is_same_v<S, float>) return VdbScalar::Float;
    if constexpr (std::is_same_v<S, double>) return VdbScalar::Double;
    return sizeof(S) == 4 ? VdbScalar::Int32 : VdbScalar::Int64;
}

// The tiles among a node's entries, boxes of `extent` cells.
template <class Node, class V>
void add_tiles(const Node& node, int extent, const V& background, const std::string& grid,
               VdbTree& out) {
    for (auto it = node.cbeginValueAll(); it; ++it) {
        if (!it.isValueOn() && it.getValue() == background) continue;
        const Vec3i lo = to_vec(it.getCoord());
        check_reach(lo, grid);
        out.tiles.push_back(
            {{lo, lo + Vec3i(extent)}, numbers_of<V>(it.getValue()), it.isValueOn()});
    }
}

// Pointers into `tree`, which must outlive them.
template <class Tree>
VdbTree parts_of(const Tree& tree, const std::string& grid) {
    using V = typename Tree::ValueType;
    using Upper = typename Tree::RootNodeType::ChildNodeType;  // 32^3 entries
    using Lower = typename Upper::ChildNodeType;               // 16^3
    using Leaf = typename Tree::LeafNodeType;
    VdbTree out;
    out.scalar = scalar_of<V>();
    out.components = openvdb::VecTraits<V>::Size == 3 ? 3 : 1;
    out.background = numbers_of<V>(tree.background());

    add_tiles(tree.root(), Upper::DIM, tree.background(), grid, out);
    std::vector<const Upper*> uppers;
    tree.getNodes(uppers);
    for (const Upper* node : uppers) add_tiles(*node, Lower::DIM, tree.background(), grid, out);
    std::vector<const Lower*> lowers;
    tree.getNodes(lowers);
    for (const Lower* node : lowers) add_tiles(*node, Leaf::DIM, tree.background(), grid, out);

    std::vector<const Leaf*> leafs;
    tree.getNodes(leafs);
    out.leafs.reserve(leafs.size());
    for (const Leaf* leaf : leafs) {
        check_reach(to_vec(leaf->origin()), grid);
        VdbLeaf part{.origin = to_vec(leaf->origin())};
        for (unsigned w = 0; w < part.active.size(); ++w) {
            part.active[w] = leaf->getValueMask().template getWord<openvdb::Index64>(w);
        }
        if constexpr (!std::is_same_v<typename Tree::BuildType, openvdb::ValueMask>) {
            part.values = leaf->buffer().data();
        }
        out.leafs.push_back(part);
    }
    return out;
}

}  // namespace gischt::vdb_detail
