// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/random.h"
#include "math/vec.h"

namespace gischt {

// An endless sequence of independent uniform numbers (SplitMix64, Steele et al. 2014): a copy
// starts where the original stands. About 2 ns per number.
class HashStream {
  public:
    explicit HashStream(std::uint64_t key) : state_(key) {}
    float next() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
    Vec2f next_two() {
        const std::uint64_t b = bits();
        return {static_cast<float>(b >> 40) * 0x1p-24f,
                static_cast<float>(b & 0xffffff) * 0x1p-24f};
    }

  private:
    std::uint64_t bits() { return mix64(state_ += 0x9e3779b97f4a7c15ULL); }
    std::uint64_t state_;
};

// The random numbers of one sample of one pixel: a pure function of (seed, frame, pixel, sample
// index, dimension), whatever other samples are taken. A dimension is one decision of the method,
// numbered by it; one(d) is the first component of two(d), so use each number once.
//
// Dimensions below stratified_dimensions (about 30 ns each) are Owen-scrambled Sobol pairs that are
// well distributed in two ways: the first 2^j samples of a pixel stratify the square, and so do,
// for each component, the first 2^j samples of an aligned block of 2^m pixels together, for every
// j and m. So neighbours err in opposite directions: the error of few samples is blue noise on the
// screen, which the eye (and a filter) forgives (the aim of Ahmed & Wonka 2020, "Screen-space
// blue-noise diffusion of Monte Carlo sampling error", who need the number of samples beforehand;
// pixel_sampler.cpp tells how this one does not). Pairs of different dimensions are independent.
// The dimensions above are hashes, independent and about 2 ns each.
class PixelSampler {
  public:
    static constexpr std::uint32_t stratified_dimensions = 32;

    PixelSampler() = default;
    // 0 <= x, y < 65536.
    PixelSampler(std::uint64_t seed, int frame, int x, int y, std::uint32_t index);

    // Sample i of `count` that a sample splits into: stratified together with all of theirs.
    PixelSampler part(std::uint32_t count, std::uint32_t i) const;

    float one(std::uint32_t dimension) const {
        return dimension < stratified_dimensions ? stratified_one(dimension) : hashed(dimension).x;
    }
    Vec2f two(std::uint32_t dimension) const {
        return dimension < stratified_dimensions ? stratified_two(dimension) : hashed(dimension);
    }
    // For decisions of unbounded number, such as the collisions of a flight.
    HashStream stream(std::uint32_t dimension) const { return HashStream(stream_key(dimension)); }
    std::uint64_t stream_key(std::uint32_t dimension) const {
        return key_ ^ mix64(0x632be59bd9b4e019ULL + dimension);
    }

  private:
    Vec2f hashed(std::uint32_t dimension) const {
        const std::uint64_t b = mix64(key_ + 0x9e3779b97f4a7c15ULL * (dimension + 1ULL));
        return {static_cast<float>(b >> 40) * 0x1p-24f,
                static_cast<float>(b & 0xffffff) * 0x1p-24f};
    }
    float stratified_one(std::uint32_t dimension) const;
    Vec2f stratified_two(std::uint32_t dimension) const;

    std::uint64_t picture_ = 0;  // of seed and frame
    std::uint64_t key_ = 0;      // of seed, frame, pixel and sample
    std::uint32_t order_ = 0;    // of the pixel along the z-curve of the picture
    std::uint32_t index_ = 0;    // of the sample
};

}  // namespace gischt
