// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace gischt {

// A point of an aperture of radius 1, uniform over its area for u in [0,1)^2: of the disc with
// fewer than three blades (concentric map, Shirley & Chiu 1997; (1/2, 1/2) is the centre), else of
// the regular polygon with its corners on the circle, the first at `rotation` radians from +x.
Vec2d aperture_point(Vec2f u, int blades, double rotation);

}  // namespace gischt
