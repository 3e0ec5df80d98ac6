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

}  // namespace gischt
