// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "math/box.h"
#include "math/vec.h"

namespace gischt {

// Light on its way from its source, at a place where it is scattered.
struct Photon {
    Vec3f position;   // m, from the origin of the map
    Vec3f direction;  // unit, in which it travelled
    // W, over the square of the index of refraction there: what is scattered in a medium, what
    // arrives at a surface.
    Vec3f power;
    std::int32_t place = 0;   // medium, or surface
    std::int32_t events = 0;  // scatterings up to this one
};

// A search tree over photons: a balanced kd-tree (Bentley 1975) with a box around each subtree, so
// that it answers for a point's nearest as well as for all photons near a ray, each being a ball
// (Jarosz, Zwicker, Jensen 2008). Eight photons make a leaf, kept by component; nodes lie in
// depth-first order, and a ray that misses one goes on behind its subtree without a stack. The same
// photons in the same order give the same tree on any number of threads.
class PhotonTree {
  public:
    PhotonTree() = default;
    explicit PhotonTree(std::vector<Photon> photons);

    bool is_empty() const { return photons_.empty(); }
    std::size_t size() const { return photons_.size(); }
    const Photon& photon(std::uint32_t i) const { return photons_[i]; }

    // Makes each photon a ball: all of one radius, or `factor` times the distance of the `nearest`
    // around its leaf's middle, but at most `most`.
    void set_radius(float radius);
    void set_radius_by_nearest(int nearest, float factor, float most);
    float radius(std::uint32_t i) const {
        return std::sqrt(leaves_[i / leaf_size].radius2[i % leaf_size]);
    }

    struct Near {
        float distance2;
        std::uint32_t photon;
        bool operator<(const Near& b) const { return distance2 < b.distance2; }
    };
    // The `count` nearest to a point closer than sqrt(most2), as a heap: the farthest first.
    void nearest(const Vec3f& point, int count, float most2, std::vector<Near>& out) const;

    // Calls found(photon, t, distance^2, radius^2) for the balls that a ray of unit direction
    // passes at t in [t0, t1], t being where it is next to their middles.
    template <class F>
    void along(const Vec3f& origin, const Vec3f& direction, float t0, float t1, F&& found) const;

  private:
    static constexpr std::size_t leaf_size = 8;
    struct Node {
        Vec3f lo, hi;
        std::int32_t end = 0;    // the first node behind the subtree
        std::int32_t leaf = -1;  // -1: the children follow
    };
    struct alignas(32) Leaf {
        std::array<float, leaf_size> x, y, z, radius2;
    };
    struct Place {
        Vec3f position;
        std::uint32_t photon;
    };
    void build(Place* places, std::size_t count, std::int32_t node, std::int32_t leaf);
    void fill(const Place* places, std::size_t count, Node& node);
    void grow_boxes();

    std::vector<Photon> photons_;  // in the order of the leaves
    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
};

template <class F>
void PhotonTree::along(const Vec3f& origin, const Vec3f& direction, float t0, float t1,
                       F&& found) const {
    const auto invert = [](float d) { return 1 / std::copysign(std::max(std::abs(d), 1e-20f), d); };
    const Vec3f inverse(invert(direction.x), invert(direction.y), invert(direction.z));
    const auto count = static_cast<std::int32_t>(nodes_.size());
    for (std::int32_t i = 0; i < count;) {
        const Node& node = nodes_[static_cast<std::size_t>(i)];
        const Vec3f a = (node.lo - origin) * inverse, b = (node.hi - origin) * inverse;
        const Vec3f in = min(a, b), out = max(a, b);
        const float begin = std::max(std::max(in.x, in.y), std::max(in.z, t0)),
                    end = std::min(std::min(out.x, out.y), std::min(out.z, t1));
        if (!(begin <= end)) {
            i = node.end;
            continue;
        }
        ++i;
        if (node.leaf < 0) continue;
        const Leaf& leaf = leaves_[static_cast<std::size_t>(node.leaf)];
        std::array<float, leaf_size> t, distance2;
        for (std::size_t k = 0; k < leaf_size; ++k) {
            const float x = leaf.x[k] - origin.x, y = leaf.y[k] - origin.y,
                        z = leaf.z[k] - origin.z;
            t[k] = x * direction.x + y * direction.y + z * direction.z;
            const float dx = x - t[k] * direction.x, dy = y - t[k] * direction.y,
                        dz = z - t[k] * direction.z;
            distance2[k] = dx * dx + dy * dy + dz * dz;
        }
        for (std::size_t k = 0; k < leaf_size; ++k) {
            if (!(distance2[k] < leaf.radius2[k]) || t[k] < t0 || t[k] > t1) continue;
            found(static_cast<std::uint32_t>(static_cast<std::size_t>(node.leaf) * leaf_size + k),
                  t[k], distance2[k], leaf.radius2[k]);
        }
    }
}

}  // namespace gischt
