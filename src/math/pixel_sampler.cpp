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

// Bit i of the result is the sum (mod 2) of the bits k of x whose number is contained in that of i.
std::uint32_t sum_over_subsets(std::uint32_t x) {
    x ^= (x & 0x55555555u) << 1;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x00ff00ffu) << 8;
    return x ^ x << 16;
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

// The index of the sample, and the place of the pixel in reversed digits, as one dimension sees
// them. Both orders are shuffled without leaving their blocks of 2^j (owen_scramble), else the
// dimensions of a pixel would be correlated.
struct Ordered {
    std::uint32_t sample, reversed_pixel;
};

Ordered shuffle(std::uint64_t bits, std::uint32_t reversed_index, std::uint32_t reversed_order) {
    // Rows or columns first: without this the blocks of an odd power of 2 would all lie.
    if (bits >> 40 & 1) {
        reversed_order = (reversed_order & 0x55555555u) << 1 | (reversed_order >> 1 & 0x55555555u);
    }
    return {reverse_bits(laine_karras(reversed_index, low(bits))),
            laine_karras(reversed_order, high(bits))};
}

// The components before the scrambling, in reversed digits, which is what it wants. C(i+k, i) is
// odd when i and k share no bit (Kummer 1852): digit i of S p sums the digits k of p contained in
// the complement of i, and the complement of i is the number of that digit's bit. Reversed, it sums
// the bits of the reversed p over supersets. P p sums p over supersets: the reversed p over
// subsets.
std::uint32_t reversed_x(const Ordered& o) {
    return o.sample ^ sum_over_supersets(o.reversed_pixel);
}
std::uint32_t reversed_y(const Ordered& o) {
    return sum_over_supersets(o.sample ^ sum_over_subsets(o.reversed_pixel));
}
float scrambled(std::uint32_t reversed, std::uint32_t seed) {
    return digits_to_unit(reverse_bits(laine_karras(reversed, seed)));
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
    const Ordered o =
        shuffle(seed_bits(picture_, 2 * dimension), reverse_bits(index_), reverse_bits(order_));
    return scrambled(reversed_x(o), low(seed_bits(picture_, 2 * dimension + 1)));
}

Vec2f PixelSampler::stratified_two(std::uint32_t dimension) const {
    const Ordered o =
        shuffle(seed_bits(picture_, 2 * dimension), reverse_bits(index_), reverse_bits(order_));
    const std::uint64_t scramble = seed_bits(picture_, 2 * dimension + 1);
    return {scrambled(reversed_x(o), low(scramble)), scrambled(reversed_y(o), high(scramble))};
}

}  // namespace gischt
