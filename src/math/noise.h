// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace gischt {

// Gradient noise in [-1,1], zero at integer points, period-free (Perlin 2002, gradients by hash of
// the lattice point). Continuous second derivatives; features have size 1.
float gradient_noise(const Vec3d& p, std::uint64_t seed);

// Fractal sum of `octaves` gradient noises: each twice as fine, `gain` as strong; divided by the
// sum of the weights.
float fractal_noise(const Vec3d& p, int octaves, float gain, std::uint64_t seed);

// Distance to the nearest of one random point per unit cell, in [0, ~1.2] (Worley 1996).
float cellular_noise(const Vec3d& p, std::uint64_t seed);

}  // namespace gischt
