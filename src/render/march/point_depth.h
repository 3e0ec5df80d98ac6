// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "optics/medium_depth.h"

namespace gischt {

// The integral of a medium's density from the points of the medium to a light at a finite place,
// marched once for each voxel that has or touches density, and trilinear between.
class PointDepth {
  public:
    PointDepth(const Medium& medium, const Vec3d& light, double spacing, const DepthSteps& steps,
               Job& job);

    // Metres times density; only for points where the medium has density.
    float operator()(const Vec3d& point) const;

  private:
    Transform to_lattice_;
    Vec3i n_;
    std::vector<float> depth_;
};

}  // namespace gischt
