// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "math/interpolate.h"
#include "math/vec.h"

namespace gischt {

enum class KeyInterpolation { Step, Linear, Smooth };

// A value over time in seconds: one constant, or keyframes t[i] -> v[i] with t ascending. Before
// the first and after the last key the value stays. In a scene file: `5` or `{ t = [0, 1], v = [0,
// 5], interpolation = "smooth" }`.
template <class T>
struct Keyed {
    std::vector<double> t;  // empty for a constant
    std::vector<T> v;       // one value for a constant, else one per key
    KeyInterpolation interpolation = KeyInterpolation::Linear;

    Keyed() : v{T{}} {}
    Keyed(const T& constant) : v{constant} {}  // implicit: a plain number is a value over time
    Keyed(std::vector<double> times, std::vector<T> values,
          KeyInterpolation kind = KeyInterpolation::Linear)
        : t(std::move(times)), v(std::move(values)), interpolation(kind) {}

    bool is_constant() const { return t.size() < 2; }
    bool operator==(const Keyed&) const = default;

    T at(double time) const {
        if (is_constant() || time <= t.front()) return v.front();
        if (time >= t.back()) return v.back();
        const auto next =
            static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), time) - t.begin());
        if (interpolation == KeyInterpolation::Step) return v[next - 1];
        double s = (time - t[next - 1]) / (t[next] - t[next - 1]);
        if (interpolation == KeyInterpolation::Smooth) s = smoothstep(s);
        return lerp(v[next - 1], v[next], s);
    }
    // Central difference over 2 ms, for speeds of keyframed things.
    T rate(double time) const {
        constexpr double e = 1e-3;
        return (at(time + e) - at(time - e)) * (0.5 / e);
    }
};

}  // namespace gischt
