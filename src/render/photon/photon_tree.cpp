// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_tree.h"

#include <tbb/parallel_invoke.h>

#include <limits>

#include "base/parallel.h"

namespace gischt {

// Subtrees below are built by one thread.
static constexpr std::size_t serial_count = 4096;

PhotonTree::PhotonTree(std::vector<Photon> photons) {
    if (photons.empty()) return;
    const std::size_t leaves = (photons.size() + leaf_size - 1) / leaf_size;
    leaves_.resize(leaves);
    nodes_.resize(2 * leaves - 1);
    std::vector<Place> places(photons.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = {photons[i].position, static_cast<std::uint32_t>(i)};
    }
    build(places.data(), places.size(), 0, 0);
    photons_.resize(photons.size());
    const int parts = static_cast<int>((photons.size() + serial_count - 1) / serial_count);
    parallel_for(parts, 1, [&](int part) {
        const auto begin = static_cast<std::size_t>(part) * serial_count;
        const std::size_t end = std::min(begin + serial_count, photons.size());
        for (std::size_t i = begin; i < end; ++i) photons_[i] = photons[places[i].photon];
    });
}

// Halves at the median along the longest edge of the box; but for the last one leaves are full, so
// that where nodes and leaves lie is known beforehand.
void PhotonTree::build(Place* places, std::size_t count, std::int32_t node, std::int32_t leaf) {
    Node& here = nodes_[static_cast<std::size_t>(node)];
    const std::size_t leaves = (count + leaf_size - 1) / leaf_size;
    here.end = node + static_cast<std::int32_t>(2 * leaves - 1);
    if (leaves == 1) {
        here.leaf = leaf;
        return fill(places, count, here);
    }
    Box3f box = Box3f::empty();
    for (std::size_t i = 0; i < count; ++i) box.extend(places[i].position);
    here.lo = box.lo;
    here.hi = box.hi;
    const Vec3f size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t near_leaves = leaves / 2, near = near_leaves * leaf_size;
    std::nth_element(places, places + near, places + count, [axis](const Place& a, const Place& b) {
        return a.position[axis] < b.position[axis] ||
               (a.position[axis] == b.position[axis] && a.photon < b.photon);
    });
    const auto far_node = node + static_cast<std::int32_t>(2 * near_leaves);
    const auto far_leaf = leaf + static_cast<std::int32_t>(near_leaves);
    if (count < serial_count) {
        build(places, near, node + 1, leaf);
        build(places + near, count - near, far_node, far_leaf);
        return;
    }
    tbb::parallel_invoke([&] { build(places, near, node + 1, leaf); },
                         [&] { build(places + near, count - near, far_node, far_leaf); });
}

void PhotonTree::fill(const Place* places, std::size_t count, Node& node) {
    Leaf& leaf = leaves_[static_cast<std::size_t>(node.leaf)];
    // Photons that are none lie where nothing comes.
    constexpr float nowhere = std::numeric_limits<float>::infinity();
    leaf.x.fill(nowhere);
    leaf.y.fill(nowhere);
    leaf.z.fill(nowhere);
    leaf.radius2.fill(-1);
    Box3f box = Box3f::empty();
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f& p = places[i].position;
        leaf.x[i] = p.x;
        leaf.y[i] = p.y;
        leaf.z[i] = p.z;
        leaf.radius2[i] = 0;
        box.extend(p);
    }
    node.lo = box.lo;
    node.hi = box.hi;
}

void PhotonTree::set_radius(float radius) {
    for (Leaf& leaf : leaves_) {
        for (float& r2 : leaf.radius2) {
            if (r2 >= 0) r2 = radius * radius;
        }
    }
    grow_boxes();
}

void PhotonTree::set_radius_by_nearest(int count, float factor, float most) {
    constexpr int part = 256;
    const auto all = static_cast<int>(leaves_.size());
    std::vector<float> radius(leaves_.size());
    parallel_ranges(all, part, [&](int begin, int end) {
        std::vector<Near> found;
        for (int l = begin; l < end; ++l) {
            const auto i = static_cast<std::size_t>(l);
            Vec3f sum;
            float n = 0;
            for (std::size_t k = 0; k < leaf_size; ++k) {
                if (leaves_[i].radius2[k] < 0) continue;
                sum += Vec3f(leaves_[i].x[k], leaves_[i].y[k], leaves_[i].z[k]);
                ++n;
            }
            nearest(sum * (1 / n), count, most * most, found);
            const bool is_full = found.size() == static_cast<std::size_t>(count);
            radius[i] = factor * (is_full ? std::sqrt(found.front().distance2) : most);
        }
    });
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        for (float& r2 : leaves_[i].radius2) {
            if (r2 >= 0) r2 = radius[i] * radius[i];
        }
    }
    grow_boxes();
}

// Children lie behind their parents.
void PhotonTree::grow_boxes() {
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        Box3f box = Box3f::empty();
        if (node.leaf < 0) {
            for (const Node& child :
                 {nodes_[i + 1], nodes_[static_cast<std::size_t>(nodes_[i + 1].end)]}) {
                box.extend({child.lo, child.hi});
            }
        } else {
            const Leaf& leaf = leaves_[static_cast<std::size_t>(node.leaf)];
            for (std::size_t k = 0; k < leaf_size; ++k) {
                if (leaf.radius2[k] < 0) continue;
                const Vec3f p(leaf.x[k], leaf.y[k], leaf.z[k]);
                const Vec3f r(std::sqrt(leaf.radius2[k]));
                box.extend(Box3f{p - r, p + r});
            }
        }
        node.lo = box.lo;
        node.hi = box.hi;
    }
}

void PhotonTree::nearest(const Vec3f& point, int count, float most2, std::vector<Near>& out) const {
    out.clear();
    if (is_empty()) return;
    const auto away = [&](std::int32_t n) {
        const Node& node = nodes_[static_cast<std::size_t>(n)];
        const Vec3f d = max(max(node.lo - point, point - node.hi), Vec3f(0));
        return dot(d, d);
    };
    struct Entry {
        float distance2;
        std::int32_t node;
    };
    std::array<Entry, 64> stack;
    std::size_t top = 0;
    stack[top++] = {away(0), 0};
    float worst = most2;
    while (top > 0) {
        const Entry entry = stack[--top];
        if (!(entry.distance2 < worst)) continue;
        const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
        if (node.leaf < 0) {
            Entry near{away(entry.node + 1), entry.node + 1};
            const std::int32_t other = nodes_[static_cast<std::size_t>(entry.node + 1)].end;
            Entry far{away(other), other};
            if (far.distance2 < near.distance2) std::swap(near, far);
            if (far.distance2 < worst) stack[top++] = far;
            if (near.distance2 < worst) stack[top++] = near;
            continue;
        }
        const Leaf& leaf = leaves_[static_cast<std::size_t>(node.leaf)];
        for (std::size_t k = 0; k < leaf_size; ++k) {
            const float x = leaf.x[k] - point.x, y = leaf.y[k] - point.y, z = leaf.z[k] - point.z;
            const float d2 = x * x + y * y + z * z;
            if (!(d2 < worst)) continue;
            if (out.size() == static_cast<std::size_t>(count)) {
                std::pop_heap(out.begin(), out.end());
                out.pop_back();
            }
            out.push_back({d2, static_cast<std::uint32_t>(
                                   static_cast<std::size_t>(node.leaf) * leaf_size + k)});
            std::push_heap(out.begin(), out.end());
            if (out.size() == static_cast<std::size_t>(count)) worst = out.front().distance2;
        }
    }
}

}  // namespace gischt
