// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "math/vec.h"

namespace gischt {

// A polynomial around a point, fitted to samples by weighted least squares: of degree two where the
// samples determine it, else of degree one, else a constant. Offsets are best of order one (cells):
// the normal equations square the condition.
class LocalFit {
  public:
    // `axes`: 2 or 3.
    explicit LocalFit(int axes) : axes_(axes) {}
    // The polynomial passes through this value at the point itself.
    void fix(double value);
    void add(const Vec3d& offset, double value, double weight);

    struct Result {
        double value = 0;  // at the point
        Vec3d gradient;    // per unit of the offsets
    };
    // Zero where nothing was added or fixed.
    Result solve(int degree = 2) const;

  private:
    static constexpr std::size_t most = 10;  // 1, x, y, z, and six squares and products
    std::size_t terms(int degree) const;
    bool solve_terms(std::size_t count, std::array<double, most>& x) const;

    int axes_;
    bool is_fixed_ = false;
    double fixed_ = 0;
    int samples_ = 0;
    std::array<std::array<double, most>, most> matrix_{};  // normal equations
    std::array<double, most> right_{};
};

}  // namespace gischt
