// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace gischt {

template <class T, class S>
constexpr T lerp(const T& a, const T& b, S t) {
    return a + (b - a) * t;
}

// Monotone cubic interpolation between f1 (t = 0) and f2 (t = 1) with outer neighbours f0 and f3:
// Hermite with central slopes, a slope being set to zero where its sign differs from that of f2 -
// f1 (Fedkiw, Stam, Jensen 2001, appendix B), and limited to three times f2 - f1, without which the
// sign rule alone can still overshoot (Fritsch & Carlson 1980).
inline float monotone_cubic(float f0, float f1, float f2, float f3, float t) {
    const float delta = f2 - f1;
    auto limit = [delta](float slope) {
        if (slope * delta <= 0) return 0.0f;
        return std::copysign(std::min(std::abs(slope), 3 * std::abs(delta)), delta);
    };
    const float d1 = limit(0.5f * (f2 - f0)), d2 = limit(0.5f * (f3 - f1));
    const float a3 = d1 + d2 - 2 * delta, a2 = 3 * delta - 2 * d1 - d2;
    return ((a3 * t + a2) * t + d1) * t + f1;
}

// 3 t^2 - 2 t^3 on [0,1], clamped outside.
template <class T>
T smoothstep(T t) {
    t = std::clamp(t, T(0), T(1));
    return t * t * (3 - 2 * t);
}

}  // namespace gischt
