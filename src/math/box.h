// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "math/vec.h"

namespace gischt {

// Axis-aligned box. Box3d: metres; Box3i: cells, half-open [lo, hi).
template <class T>
struct Box3 {
    Vec3<T> lo, hi;

    // Contains nothing; the neutral element of extend().
    static constexpr Box3 empty() {
        return {Vec3<T>(std::numeric_limits<T>::max()), Vec3<T>(std::numeric_limits<T>::lowest())};
    }
    constexpr bool is_empty() const { return !(lo.x < hi.x && lo.y < hi.y && lo.z < hi.z); }
    constexpr Vec3<T> size() const { return hi - lo; }
    constexpr bool operator==(const Box3&) const = default;
    constexpr bool contains(const Vec3<T>& p) const {
        return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x < hi.x && p.y < hi.y && p.z < hi.z;
    }
    constexpr void extend(const Vec3<T>& p) {
        lo = min(lo, p);
        hi = max(hi, p);
    }
    constexpr void extend(const Box3& b) {
        lo = min(lo, b.lo);
        hi = max(hi, b.hi);
    }
};

using Box3i = Box3<int>;
using Box3f = Box3<float>;
using Box3d = Box3<double>;

template <class T>
constexpr Box3<T> intersection(const Box3<T>& a, const Box3<T>& b) {
    return {max(a.lo, b.lo), min(a.hi, b.hi)};
}

}  // namespace gischt
