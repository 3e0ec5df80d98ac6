// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shape/mesh_distance.h"

namespace gischt {

// Signed distances to a mesh on the points of a lattice around it, for many cheap look-ups in the
// mesh's own frame: linear between the points, so off by about spacing^2 / (8 radius of curvature).
// 4 bytes per point. Immutable after construction; safe to use from several threads.
class DistanceLattice {
  public:
    DistanceLattice() = default;
    // `spacing` of the points, m; distances are cut off at +-`limit` m. Throws Error{Usage} when
    // either is not positive or the points are more than 2^30.
    DistanceLattice(const MeshDistance& mesh, double spacing, double limit);

    // Metres to the surface, negative inside, within +-limit; `limit` far outside.
    double at(const Vec3d& p) const;

  private:
    Vec3d origin_;
    Vec3i count_;
    double spacing_ = 1, limit_ = 0;
    std::vector<float> values_;  // x fastest
};

}  // namespace gischt
