// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/fit.h"

#include <algorithm>
#include <cmath>

namespace gischt {

void LocalFit::fix(double value) {
    is_fixed_ = true;
    fixed_ = value;
}

std::size_t LocalFit::terms(int degree) const {
    const std::size_t constant = is_fixed_ ? 0 : 1;
    if (degree == 0) return constant;
    const auto n = static_cast<std::size_t>(axes_);
    return constant + n + (degree == 1 ? 0 : n * (n + 1) / 2);
}

// Terms of lower degree come first: the leading part of the equations is that of a lower degree.
void LocalFit::add(const Vec3d& offset, double value, double weight) {
    std::array<double, most> basis{};
    std::size_t n = 0;
    if (!is_fixed_) basis[n++] = 1;
    for (int a = 0; a < axes_; ++a) basis[n++] = offset[a];
    for (int a = 0; a < axes_; ++a) {
        for (int b = a; b < axes_; ++b) basis[n++] = offset[a] * offset[b];
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) matrix_[i][j] += weight * basis[i] * basis[j];
        right_[i] += weight * basis[i] * (value - fixed_);
    }
    ++samples_;
}

// Gaussian elimination with pivots on the diagonal, the equations being symmetric and positive;
// false where they do not determine the terms.
bool LocalFit::solve_terms(std::size_t count, std::array<double, most>& x) const {
    constexpr double least_pivot = 1e-9;  // of the diagonal: what eliminations leave of rounding
    auto m = matrix_;
    x = right_;
    for (std::size_t k = 0; k < count; ++k) {
        if (!(m[k][k] > least_pivot * matrix_[k][k])) return false;
        for (std::size_t i = k + 1; i < count; ++i) {
            const double factor = m[i][k] / m[k][k];
            for (std::size_t j = k; j < count; ++j) m[i][j] -= factor * m[k][j];
            x[i] -= factor * x[k];
        }
    }
    for (std::size_t k = count; k-- > 0;) {
        for (std::size_t j = k + 1; j < count; ++j) x[k] -= m[k][j] * x[j];
        x[k] /= m[k][k];
    }
    return true;
}

LocalFit::Result LocalFit::solve(int degree) const {
    Result result;
    result.value = fixed_;
    for (int d = degree; d >= 0; --d) {
        const std::size_t count = terms(d);
        std::array<double, most> x{};
        // As many samples as terms fit anything: noise too.
        if (count == 0 || static_cast<std::size_t>(samples_) < count || !solve_terms(count, x)) {
            continue;
        }
        std::size_t n = 0;
        if (!is_fixed_) result.value = x[n++];
        for (int a = 0; a < axes_ && d > 0; ++a) result.gradient[a] = x[n++];
        break;
    }
    return result;
}

}  // namespace gischt
