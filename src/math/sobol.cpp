// SPDX-License-Identifier: Apache-2.0
#include "math/sobol.h"

#include "base/random.h"

namespace gischt {

std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
}

// A hash in which bit i of the result depends on bits 0..i only (Laine & Karras 2011), with the
// rounds and constants of Vegdahl 2021, "Building a better LK hash": those of Burley 2020 leave
// padded dimensions visibly correlated for some seeds.
static std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

// The direction numbers of the second dimension are Pascal's triangle mod 2: digit i of the result
// is the sum of the digits k of the index with C(k, i) odd, which are those whose bits contain the
// bits of i (Lucas 1878). That sum over supersets takes one step per bit of the digit's number.
std::uint32_t sobol_second(std::uint32_t index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0f0f0f0fu;
    index ^= index >> 8 & 0x00ff00ffu;
    index ^= index >> 16;
    return reverse_bits(index);
}

Vec2f sobol_2d(std::uint32_t index, std::uint32_t seed) {
    const std::uint64_t key = random_key(seed);
    index = owen_scramble(index, random_bits(key, 0));
    return {digits_to_unit(owen_scramble(reverse_bits(index), random_bits(key, 1))),
            digits_to_unit(owen_scramble(sobol_second(index), random_bits(key, 2)))};
}

float sobol_1d(std::uint32_t index, std::uint32_t seed) {
    return digits_to_unit(owen_scramble(reverse_bits(index), random_bits(random_key(seed), 1)));
}

}  // namespace gischt
