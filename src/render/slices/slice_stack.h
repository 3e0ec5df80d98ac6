// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "math/box.h"

namespace gischt {

// How much each of the three stacks of slices, across x, y and z, adds to the picture: all of it
// the one whose axis has the largest absolute dot product with the view direction, except where
// another comes within `fade` of it. There they mix, so that the picture changes continuously while
// the camera turns. The shares sum to 1 and are a continuous function of the direction for fade >
// 0.
std::array<double, 3> stack_shares(const Vec3d& direction, double fade);

// Planes across an axis of a box, in the order in which they are drawn.
struct SliceRun {
    double first = 0, step = 0;  // coordinate along the axis, metres
    int count = 0;
};

// From back to front as seen from an eye at that coordinate; for parallel rays, an infinite one.
// `count` slices, each in the middle of an equal part of [low, high], moved by (phase - 1/2) parts.
// An eye between the slices sees two runs, one to each side.
std::vector<SliceRun> slice_runs(double low, double high, int count, double phase, double eye);

}  // namespace gischt
