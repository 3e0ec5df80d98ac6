// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gischt {

// A good 64-bit mixer (Stafford 2011, variant 13: the finalizer of SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ULL;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

// A key for the random numbers of one thing: fold in seed, frame, pixel or cell, sample, one after
// the other.
constexpr std::uint64_t random_key(std::uint64_t seed) {
    return mix64(seed + 0x9e3779b97f4a7c15ULL);
}
template <class... Rest>
constexpr std::uint64_t random_key(std::uint64_t seed, std::uint64_t next, Rest... rest) {
    return random_key(random_key(seed) ^ (next * 0xd1342543de82ef95ULL), rest...);
}

// 32 random bits as a pure function of key and dimension.
constexpr std::uint32_t random_bits(std::uint64_t key, std::uint32_t dimension) {
    return static_cast<std::uint32_t>(mix64(key + 0x9e3779b97f4a7c15ULL * (dimension + 1ULL)) >>
                                      32);
}

// Uniform in [0,1): 24 bits, so that 1 is never reached in float.
constexpr float random_uniform(std::uint64_t key, std::uint32_t dimension) {
    return static_cast<float>(random_bits(key, dimension) >> 8) * 0x1p-24f;
}

}  // namespace gischt
