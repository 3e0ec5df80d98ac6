// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace gischt {

// Gradient noise in [-1,1], zero at integer points, period-free (Perlin 2002, gradients by hash of
// the lattice point). Continuous second derivatives; features have size 1.
float gradient_noise(const Vec3d& p, std::uint64_t seed);

// The same in four dimensions, the fourth for time: in [-sqrt(3), sqrt(3)], zero at integer (p, w),
// of mean 0 and variance 0.0857. The gradients are the 32 directions of a hypercube's edges (Perlin
// 2002). Costs half where w is an integer.
float gradient_noise(const Vec3d& p, double w, std::uint64_t seed);

// Fractal sum of `octaves` gradient noises: each twice as fine, `gain` as strong; divided by the
// sum of the weights.
float fractal_noise(const Vec3d& p, int octaves, float gain, std::uint64_t seed);

// Distance to the nearest of one random point per unit cell, in [0, ~1.2] (Worley 1996).
float cellular_noise(const Vec3d& p, std::uint64_t seed);

// Curl of a vector of three independent gradient noises: a velocity without divergence (Bridson,
// Houriham, Nordenstam 2007, "Curl-noise for procedural fluid flow"). Features have size 1, the
// root mean square of its length is curl_of_noise_rms, the first derivatives are continuous.
Vec3d curl_of_noise(const Vec3d& p, std::uint64_t seed);

// With W = 1 - fade(x), gradients of variance 2/3 per component and integrals over [0,1]:
// mean square = 32 int(W'^2 x^2) int(W^2)^2 + 64 int(W'^2) int(W^2 x^2) int(W^2) = 2.9772.
inline constexpr double curl_of_noise_rms = 1.72545;

// Distances to the nearest and the second nearest of one random point per unit cell (Worley 1996),
// exact however far they are. Each point swings in its cell with its own phase, through all of it
// in a unit of w; the distribution is the same at every w.
struct CellDistances {
    float first = 0, second = 0;
};
CellDistances cell_distances(const Vec3d& p, double w, std::uint64_t seed);

}  // namespace gischt
