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

// The same in whole numbers, digits after the point being the bits from the highest on.

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
}

// Bit i of the result is the sum (mod 2) of the bits k of x whose number contains that of i, i & k
// == i. As a matrix: Pascal's triangle C(k, i) mod 2 (Lucas 1878). One step per bit of the number.
inline std::uint32_t sum_over_supersets(std::uint32_t x) {
    x ^= x >> 1 & 0x55555555u;
    x ^= x >> 2 & 0x33333333u;
    x ^= x >> 4 & 0x0f0f0f0fu;
    x ^= x >> 8 & 0x00ff00ffu;
    return x ^ x >> 16;
}

// The two components of point `index` of the sequence, not scrambled, are reverse_bits(index) and
// this: the direction numbers of the second one are Pascal's triangle mod 2.
inline std::uint32_t sobol_second(std::uint32_t index) {
    return reverse_bits(sum_over_supersets(index));
}

// A hash in which bit i of the result depends on bits 0..i only (Laine & Karras 2011), with the
// rounds and constants of Vegdahl 2021, "Building a better LK hash": those of Burley 2020 leave
// padded dimensions visibly correlated for some seeds.
inline std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Nested uniform (Owen) scrambling: bit i of the result is bit i of x or its complement, which of
// them depends on the seed and the bits above i.
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

// In [0,1); the lowest 8 bits are dropped, so that 1 is never reached.
inline float digits_to_unit(std::uint32_t x) {
    return static_cast<float>(x >> 8) * 0x1p-24f;
}

}  // namespace gischt
