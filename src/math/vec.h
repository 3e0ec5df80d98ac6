// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gischt {

// Small vectors of 2 or 3 numbers; arithmetic is component by component.
template <class T>
struct Vec2 {
    T x{}, y{};
    constexpr bool operator==(const Vec2&) const = default;
};

template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T a, T b, T c) : x(a), y(b), z(c) {}
    explicit constexpr Vec3(T all) : x(all), y(all), z(all) {}
    template <class U>
    explicit constexpr Vec3(const Vec3<U>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

    constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr bool operator==(const Vec3&) const = default;

    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
    constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator*(const Vec3& a, const Vec3& b) {
        return {a.x * b.x, a.y * b.y, a.z * b.z};
    }
    friend constexpr Vec3 operator/(const Vec3& a, const Vec3& b) {
        return {a.x / b.x, a.y / b.y, a.z / b.z};
    }
    friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
    friend constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
};

using Vec2i = Vec2<int>;
using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3i = Vec3<int>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(const Vec3<T>& a) {
    return std::sqrt(dot(a, a));
}
template <class T>
Vec3<T> normalize(const Vec3<T>& a) {
    return a / length(a);
}
template <class T>
constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> abs(const Vec3<T>& a) {
    return {a.x < 0 ? -a.x : a.x, a.y < 0 ? -a.y : a.y, a.z < 0 ? -a.z : a.z};
}
template <class T>
constexpr T max_component(const Vec3<T>& a) {
    return std::max({a.x, a.y, a.z});
}
template <class T>
constexpr T min_component(const Vec3<T>& a) {
    return std::min({a.x, a.y, a.z});
}
inline Vec3f exp(const Vec3f& a) {
    return {std::exp(a.x), std::exp(a.y), std::exp(a.z)};
}
inline Vec3i floor(const Vec3d& a) {
    return {static_cast<int>(std::floor(a.x)), static_cast<int>(std::floor(a.y)),
            static_cast<int>(std::floor(a.z))};
}

// Product of the components, as a size: the number of cells in a box of n.
constexpr std::size_t volume(const Vec3i& n) {
    return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) *
           static_cast<std::size_t>(n.z);
}

// Two unit vectors that form a right-handed orthonormal frame (s, t, n) with the unit vector n
// (Duff et al. 2017).
template <class T>
void orthonormal_frame(const Vec3<T>& n, Vec3<T>& s, Vec3<T>& t) {
    const T sign = std::copysign(T(1), n.z);
    const T a = T(-1) / (sign + n.z), b = n.x * n.y * a;
    s = {T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace gischt
