// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "math/box.h"
#include "shape/mesh.h"

namespace gischt {

// Distances to a closed mesh, by a tree of boxes over its triangles. Immutable; safe to use from
// several threads.
class MeshDistance {
  public:
    // Throws Error{Input} for a mesh that is empty or not closed, and for points that are missing
    // or not finite. It does not matter which way round the triangles are turned.
    explicit MeshDistance(const Mesh& mesh);

    // Metres to the nearest triangle, at most `limit`. Some log n boxes near the surface.
    double distance(const Vec3d& p, double limit = std::numeric_limits<double>::infinity()) const;
    // Whether the surface goes around a point: by its winding number, the sum of the solid angles
    // of the triangles over 4 pi, where far triangles count as one dipole (Jacobson, Kavan,
    // Sorkine 2013; Barill et al. 2018). Parts that overlap are one body.
    bool is_inside(const Vec3d& p) const;
    // Around all triangles, m.
    const Box3d& bounds() const { return nodes_.front().box; }

  private:
    struct Triangle {
        Vec3d a, b, c;
    };
    struct Node {
        Box3d box;
        int first = 0, count = 0;  // triangles of a leaf
        int second = 0;            // the second child; the first one follows its parent
        Vec3d area, middle;        // m^2, m: sum of area vectors, mean place weighted by area
        double radius = 0;         // m from the middle to the farthest corner
    };

    int build(int first, int count);
    void nearest(int node, const Vec3d& p, double& best) const;
    double solid_angle(int node, const Vec3d& p) const;

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace gischt
