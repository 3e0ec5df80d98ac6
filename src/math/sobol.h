// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace gischt {

// Point `index` of the two-dimensional Sobol sequence ((0,2)-sequence in base 2), Owen-scrambled by
// hashes of `seed` (Burley 2020, "Practical hash-based Owen scrambling"). Different seeds give
// independent scramblings, so that a sampler pads as many dimensions as it needs with pairs of
// different seeds. Components in [0,1).
Vec2f sobol_2d(std::uint32_t index, std::uint32_t seed);

// First component of sobol_2d without the shuffle of the index: stratified in one dimension.
float sobol_1d(std::uint32_t index, std::uint32_t seed);

// The same in whole numbers: binary digits after the point, the highest bit first.

// The two components of point `index`, not scrambled.
std::uint32_t reverse_bits(std::uint32_t index);
std::uint32_t sobol_second(std::uint32_t index);
// Nested uniform (Owen) scrambling by a hash: bit i of the result is bit i of x or its complement,
// which of them depends on the seed and the bits above i.
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed);
// In [0,1); the lowest 8 bits are dropped, so that 1 is never reached.
inline float digits_to_unit(std::uint32_t x) {
    return static_cast<float>(x >> 8) * 0x1p-24f;
}

}  // namespace gischt
