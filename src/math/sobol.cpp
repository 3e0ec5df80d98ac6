// SPDX-License-Identifier: Apache-2.0
#include "math/sobol.h"

#include "base/random.h"

namespace gischt {

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
