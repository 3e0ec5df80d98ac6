// SPDX-License-Identifier: Apache-2.0
#include "math/pixel_sampler.h"

#include "math/sobol.h"

// The construction. Write the sample's index s and the pixel's place p along the z-curve as vectors
// of binary digits, the lowest first. The digits after the point of one component are
//   A s + B p  (mod 2),
// then Owen-scrambled. A is that of the Sobol sequence: its first j columns span the first j
// digits, so 2^j samples of a pixel fall into 2^j different strata. The samples of 2^m pixels that
// share all but their lowest m digits of p fall into different ones of 2^(j+m) strata exactly when
// rows j..j+m-1 of the first m columns of B are invertible. For all j and m at once this holds
// for the symmetric Pascal matrix S_ik = C(i+k, i): column k is a polynomial of degree k in i with
// leading coefficient 1/k!, so each such minor is a Vandermonde determinant divided by factorials,
// and equals 1. It stays true when the columns are mixed by an upper triangular matrix. So B = S
// for the first component and B = S P for the second, P being the upper triangular Pascal matrix
// of Sobol's second dimension; at one sample per pixel, S and S P make the pixels of a block a
// (0,2)-net, as the identity and P do (S = L P with L lower triangular, and P^2 = 1 mod 2).

namespace gischt {
namespace {

// Bits of x at the even positions.
std::uint32_t spread_bits(std::uint32_t x) {
    x &= 0xffffu;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

// S p as digits after the point. C(i+k, i) is odd when i and k share no bit (Kummer 1852): digit i
// sums the digits k of p within the complement of i, and digit i is bit 31 - i, the complement of
// i. So bit b of the result sums the bits k of p whose number k is contained in b.
std::uint32_t symmetric_pascal(std::uint32_t p) {
    p ^= (p & 0x55555555u) << 1;
    p ^= (p & 0x33333333u) << 2;
    p ^= (p & 0x0f0f0f0fu) << 4;
    p ^= (p & 0x00ff00ffu) << 8;
    return p ^ p << 16;
}

std::uint32_t low(std::uint64_t x) {
    return static_cast<std::uint32_t>(x);
}
std::uint32_t high(std::uint64_t x) {
    return static_cast<std::uint32_t>(x >> 32);
}

std::uint64_t seed_bits(std::uint64_t key, std::uint32_t i) {
    return mix64(key + 0x9e3779b97f4a7c15ULL * (i + 1ULL));
}

// The index of the sample and the place of the pixel as one dimension sees them. Both orders are
// shuffled without leaving their blocks of 2^j, else the dimensions of a pixel would be correlated.
struct Ordered {
    std::uint32_t sample, pixel;
};

Ordered shuffle(std::uint64_t bits, std::uint32_t index, std::uint32_t order) {
    // Rows or columns first: without this the blocks of an odd power of 2 would all lie.
    if (bits >> 40 & 1) order = (order & 0x55555555u) << 1 | (order >> 1 & 0x55555555u);
    return {owen_scramble(index, low(bits)), owen_scramble(order, high(bits))};
}

}  // namespace

PixelSampler::PixelSampler(std::uint64_t seed, int frame, int x, int y, std::uint32_t index)
    : picture_(random_key(seed, static_cast<std::uint64_t>(frame))),
      order_(spread_bits(static_cast<std::uint32_t>(x)) | spread_bits(static_cast<std::uint32_t>(y))
                                                              << 1),
      index_(index) {
    key_ = random_key(picture_, order_, index);
}

PixelSampler PixelSampler::part(std::uint32_t count, std::uint32_t i) const {
    PixelSampler p = *this;
    p.index_ = index_ * count + i;
    p.key_ = random_key(picture_, order_, p.index_);
    return p;
}

float PixelSampler::stratified_one(std::uint32_t dimension) const {
    const Ordered o = shuffle(seed_bits(picture_, 2 * dimension), index_, order_);
    const std::uint64_t scramble = seed_bits(picture_, 2 * dimension + 1);
    const std::uint32_t x = reverse_bits(o.sample) ^ symmetric_pascal(o.pixel);
    return digits_to_unit(owen_scramble(x, low(scramble)));
}

Vec2f PixelSampler::stratified_two(std::uint32_t dimension) const {
    const Ordered o = shuffle(seed_bits(picture_, 2 * dimension), index_, order_);
    const std::uint64_t scramble = seed_bits(picture_, 2 * dimension + 1);
    const std::uint32_t x = reverse_bits(o.sample) ^ symmetric_pascal(o.pixel);
    const std::uint32_t y =
        sobol_second(o.sample) ^ symmetric_pascal(reverse_bits(sobol_second(o.pixel)));
    return {digits_to_unit(owen_scramble(x, low(scramble))),
            digits_to_unit(owen_scramble(y, high(scramble)))};
}

}  // namespace gischt
