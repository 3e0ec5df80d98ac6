// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "optics/light.h"

namespace gischt {

// The irradiance of a light at infinity that nothing blocks, as a function of the surface's normal:
// what is left to be estimated at a point is the part that is blocked. Within about 2e-3 of its
// largest value: 4096 directions drawn from the light, summed for 48 x 25 normals by longitude and
// latitude, bilinear between; the axes are nodes. Takes some 20 ms.
class IrradianceMap {
  public:
    explicit IrradianceMap(const Light& light);

    // W/m^2 on a plane of that unit normal.
    Vec3f operator()(const Vec3d& normal) const;

  private:
    std::vector<Vec3f> nodes_;  // longitude fastest
};

}  // namespace gischt
