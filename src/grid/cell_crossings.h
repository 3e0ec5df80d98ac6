// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "math/vec.h"

namespace gischt {

// Where a line leaves one interpolation cell for the next: the t in ]0, length[ at which entry + t
// step crosses a plane of whole local coordinates, ascending. Between two of them a trilinear
// interpolant is a cubic polynomial of t, which two Gauss points integrate exactly. Writes to
// `out`, which must have room for max_crossings(step, length), and returns how many there are.
int cell_crossings(const Vec3f& entry, const Vec3f& step, float length, std::span<float> out);

// A bound on the number of crossings.
int max_crossings(const Vec3f& step, float length);

}  // namespace gischt
