// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace gischt {

__extension__ typedef __int128 Int128;

// A sum in fixed point: exact, so that its bits do not depend on the order of the terms nor on how
// they were grouped. One term is cut to a multiple of 2^-64 (5e-20), which adds at most 2^-64 times
// the number of terms to the error; the sum must stay within +-2^63 (9e18). So 2^24 terms below
// term_limit never overflow; whoever adds looks at `fits` first.
class ExactSum {
  public:
    static constexpr double term_limit = 0x1p39;  // 5e11
    // False for what is not a number too.
    static bool fits(double term) { return std::abs(term) < term_limit; }

    void add(double term) { units_ += static_cast<Int128>(term * 0x1p64); }
    void add(const ExactSum& other) { units_ += other.units_; }
    double value() const { return static_cast<double>(units_) * 0x1p-64; }

    // For files: the sum in units of 2^-64.
    Int128 units() const { return units_; }
    void set_units(Int128 units) { units_ = units; }
    bool operator==(const ExactSum&) const = default;

  private:
    Int128 units_ = 0;
};

// The same for squares of what fits an ExactSum: they reach 2^78, while those of dark pictures are
// tiny. 192 bits; resolution 2^-64, 2^24 squares never overflow.
class ExactSquareSum {
  public:
    // A term x^2, not negative.
    void add(double square) {
        const auto coarse = static_cast<Int128>(square * 0x1p24);
        const double rest = square - static_cast<double>(coarse) * 0x1p-24;
        coarse_ += coarse;
        fine_ += static_cast<std::uint64_t>(rest * 0x1p64);
    }
    void add(const ExactSquareSum& other) {
        coarse_ += other.coarse_;
        fine_ += other.fine_;
    }
    double value() const {
        return static_cast<double>(coarse_) * 0x1p-24 + static_cast<double>(fine_) * 0x1p-64;
    }

    Int128 coarse_units() const { return coarse_; }     // of 2^-24
    std::uint64_t fine_units() const { return fine_; }  // of 2^-64, each term's below 2^-24
    void set_units(Int128 coarse, std::uint64_t fine) {
        coarse_ = coarse;
        fine_ = fine;
    }
    bool operator==(const ExactSquareSum&) const = default;

  private:
    Int128 coarse_ = 0;
    std::uint64_t fine_ = 0;
};

}  // namespace gischt
