// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/path/spectral.h"

namespace gischt {

// The random numbers that make a path, as the state of a Markov chain (Kelemen et al. 2002, "A
// simple and robust mutation strategy for the Metropolis light transport algorithm"). They lie in
// tracks, one for each decision of unknown length, so that a flight that takes a number more does
// not move what comes after it. A number is made when it is asked for, and its mutations since then
// are made up for at once.
class PrimaryNumbers {
  public:
    // A path of independent numbers, a pure function of the key.
    explicit PrimaryNumbers(std::uint64_t start);

    // From here on mutations by numbers of their own.
    void mutate_by(std::uint64_t key, double sigma) {
        key_ = key;
        drawn_ = 0;
        sigma_ = sigma;
    }

    // Proposes a next state: all numbers anew, or each moved a little. Then accept() or reject().
    void propose(bool is_large);
    // Or the numbers of one track anew, and all others as they are.
    void propose_track(std::size_t track);
    void accept();
    void reject();

    // The number at a place of a track.
    float at(std::size_t track, std::size_t place);

  private:
    struct Number {
        float value = 0, kept = 0;
        std::int64_t changed = -1, kept_changed = -1;  // the mutation up to which it is made
    };
    static constexpr std::size_t every = ~std::size_t{0};
    float moved(float value, double sigma);
    float draw() { return random_uniform(key_, drawn_++); }

    std::uint64_t start_ = 0, key_ = 0;
    std::uint32_t drawn_ = 0;
    double sigma_ = 0.01;
    std::int64_t now_ = 0;         // the mutation
    std::int64_t last_large_ = 0;  // that was accepted, or is proposed
    std::int64_t kept_large_ = 0;
    std::size_t only_ = every;  // the track that the proposal takes anew
    std::vector<std::vector<Number>> tracks_;
};

// The tracks of one subpath as a source of numbers.
class TrackSource : public NumberSource {
  public:
    // Tracks first, first + stride, ...
    TrackSource(PrimaryNumbers& numbers, std::size_t first, std::size_t stride)
        : numbers_(numbers), first_(first), stride_(stride), track_(first) {}
    float next() override { return numbers_.at(track_, place_++); }
    void begin(std::size_t part) override {
        track_ = first_ + stride_ * part;
        place_ = 0;
    }

  private:
    PrimaryNumbers& numbers_;
    std::size_t first_, stride_, track_, place_ = 0;
};

}  // namespace gischt
