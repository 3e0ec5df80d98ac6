// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace gischt {

// Mean and variance of a stream of numbers in one pass (Welford 1962).
struct RunningStatistics {
    std::int64_t count = 0;
    double mean = 0, squares = 0;  // squares: sum of squared deviations

    void add(double x) {
        ++count;
        const double d = x - mean;
        mean += d / static_cast<double>(count);
        squares += d * (x - mean);
    }
    double variance() const { return count > 1 ? squares / static_cast<double>(count - 1) : 0; }
    double standard_error() const {
        return count > 0 ? std::sqrt(variance() / static_cast<double>(count)) : 0;
    }
};

}  // namespace gischt
