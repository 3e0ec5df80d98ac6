// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/types.h"
#include "math/box.h"

namespace gischt {

// Where an eye or a light is: a point in metres, or the unit vector towards it.
struct SeenFrom {
    Vec3d place;
    bool is_infinite = false;
};

// Planes across the half vector of the directions to the light and to the eye, or away from the eye
// where the light is behind: then both see them in one order, or in opposite ones (Kniss et al.
// 2003). Slice i is at first + i step along `across`; the light meets slice 0 first.
struct HalfAnglePlanes {
    Vec3d across, s, t;          // unit, orthogonal to each other
    Vec2d s_range, t_range;      // of the box, metres along s and t
    double first = 0, step = 0;  // metres; step < 0
    int count = 0;
    bool is_front_to_back = true;  // for the eye
};

// Through the box from -half to half with cells of that size, in metres: at most `spacing` cells
// apart. `phase` moves them as in slice_runs(). Throws Error{Usage} where light or eye is
// so near that it would see slices from both sides.
HalfAnglePlanes half_angle_planes(const Vec3d& half, const Vec3d& cell, double spacing,
                                  double phase, const SeenFrom& eye, const SeenFrom& light);

// From a point of that box to the picture that the light sees, from -1 to 1 in x and y, depth 0.
// Throws Error{Usage} where the box is more than 140 degrees wide as seen from the light.
GlMatrix light_projection(const Vec3d& half, const SeenFrom& light);

}  // namespace gischt
