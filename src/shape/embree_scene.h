// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/box.h"
#include "math/ray.h"

namespace gischt {

// Triangles to be hit by rays, at rest or in even motion between two moments.
struct TriangleObject {
    // Metres; `points_end`, where they are at the end of the shutter, is empty for one at rest.
    std::vector<Vec3d> points, points_end;
    std::vector<Vec3i> triangles;
    // Rays that skip one of these bits pass the object.
    std::uint32_t bits = 0;
};

struct TriangleHit {
    double t = 0;       // in lengths of the ray's direction
    Vec3d point;        // on the triangle
    Vec3d normal;       // unit; on the side from which the corners run counterclockwise
    Vec2d barycentric;  // weights of the second and the third corner
    int object = 0, triangle = 0;
    // Metres. A new ray that starts this far off the point along the normal, to either side, does
    // not meet the triangle again: a bound of the rounding in the search, which is done in float
    // (after Waechter & Binder 2019, "A fast and robust method for avoiding self-intersection").
    double offset = 0;
};

// A search tree over triangles (Embree 3, Wald et al. 2014). Rays do not slip through shared edges
// (through a corner at most when they meet it to the last digit).
// The same triangles give the same hits, whatever the number of threads. Immutable; copies share
// their content; safe to use from several threads.
class EmbreeScene {
  public:
    EmbreeScene() = default;  // nothing
    // Throws Error{Resource} when the memory does not suffice. Points must be finite and triangles
    // point to points (shape/mesh.h: remove_faults).
    explicit EmbreeScene(std::vector<TriangleObject> objects);

    bool is_empty() const { return !content_; }
    // The nearest hit in [t_min, t_max]; `moment` in [0,1] is the time between both positions.
    std::optional<TriangleHit> intersect(const Ray& ray, float moment = 0,
                                         std::uint32_t skip = 0) const;
    bool is_blocked(const Ray& ray, float moment = 0, std::uint32_t skip = 0) const;
    // Every hit in [t_min, t_max], in ascending order.
    std::vector<TriangleHit> all_hits(const Ray& ray, float moment = 0) const;
    // Around all triangles at all moments; empty without any.
    Box3d bounds() const;

  private:
    struct Content;
    std::shared_ptr<const Content> content_;
};

}  // namespace gischt
