// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/keyframes.h"

namespace gischt {

// The integral of a value over time from 0 to `time`, which may be negative: how far a velocity has
// carried something. Exact, up to rounding, for every interpolation.
template <class T>
T integral(const Keyed<T>& value, double time) {
    if (value.is_constant()) return value.v.front() * time;
    // From each key to the next: Simpson's rule has no error for cubics, the middle none for steps.
    const auto piece = [&](double a, double b) {
        const T middle = value.at(0.5 * (a + b));
        if (value.interpolation == KeyInterpolation::Step) return middle * (b - a);
        return (value.at(a) + middle * 4.0 + value.at(b)) * ((b - a) / 6);
    };
    const double first = std::min(0.0, time), last = std::max(0.0, time);
    T sum{};
    double from = first;
    for (const double key : value.t) {
        if (key <= from || key >= last) continue;
        sum = sum + piece(from, key);
        from = key;
    }
    sum = sum + piece(from, last);
    return time < 0 ? sum * -1.0 : sum;
}

}  // namespace gischt
