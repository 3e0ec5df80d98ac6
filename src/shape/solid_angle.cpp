// SPDX-License-Identifier: Apache-2.0
#include "shape/solid_angle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace gischt {
namespace {

// What is left of v perpendicular to the unit vector n, unit.
Vec3d across(const Vec3d& v, const Vec3d& n) {
    return normalize(v - dot(v, n) * n);
}

double clamped_acos(double c) {
    return std::acos(std::clamp(c, -1.0, 1.0));
}

}  // namespace

double triangle_solid_angle(const Vec3d& from, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d p = a - from, q = b - from, r = c - from;
    const double lp = length(p), lq = length(q), lr = length(r);
    const double volume6 = dot(p, cross(q, r));
    const double rest = lp * lq * lr + dot(p, q) * lr + dot(p, r) * lq + dot(q, r) * lp;
    return 2 * std::abs(std::atan2(std::abs(volume6), rest));
}

double disc_solid_angle(const Vec3d& from, const Vec3d& center, const Vec3d& normal,
                        double radius) {
    const Vec3d d = from - center;
    const double h = std::abs(dot(d, normal)), r = length(d - dot(d, normal) * normal);
    if (h == 0) return 0;
    // In polar coordinates around the foot of the point the cone under an edge at distance s has
    // the solid angle dphi (1 - h / sqrt(h^2 + s^2)); by the angle t along the disc's edge instead,
    // dphi = edge x d(edge) / s^2. The integrand is periodic: the trapezoidal rule is exact but for
    // a term that falls exponentially.
    constexpr int n = 512;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double t = 2 * pi * (i + 0.5) / n;
        const double x = radius * std::cos(t) - r, y = radius * std::sin(t);
        const double s2 = x * x + y * y, l = std::sqrt(h * h + s2);
        const double turn = radius * (radius - r * std::cos(t));
        // (1 - h / l) / s^2 = 1 / (l (l + h)), which has no pole at the edge.
        sum += turn / (l * (l + h));
    }
    return std::abs(sum * 2 * pi / n);
}

SphericalRectangle::SphericalRectangle(const Vec3d& from, const Vec3d& corner, const Vec3d& edge_x,
                                       const Vec3d& edge_y)
    : from_(from), x_(normalize(edge_x)), y_(normalize(edge_y)), z_(cross(x_, y_)) {
    const Vec3d d = corner - from;
    x0_ = dot(d, x_);
    y0_ = dot(d, y_);
    z0_ = dot(d, z_);
    x1_ = x0_ + length(edge_x);
    y1_ = y0_ + length(edge_y);
    if (z0_ > 0) {
        z_ = -z_;
        z0_ = -z0_;
    }
    if (z0_ == 0) return;
    // Unit normals of the planes through the point and an edge; inner angles between them.
    const std::array<Vec3d, 4> corners{Vec3d{x0_, y0_, z0_}, Vec3d{x1_, y0_, z0_},
                                       Vec3d{x1_, y1_, z0_}, Vec3d{x0_, y1_, z0_}};
    std::array<Vec3d, 4> n;
    for (std::size_t i = 0; i < 4; ++i) {
        n[i] = normalize(cross(corners[i], corners[(i + 1) % 4]));
    }
    std::array<double, 4> angle{};
    for (std::size_t i = 0; i < 4; ++i) angle[i] = clamped_acos(-dot(n[i], n[(i + 1) % 4]));
    b0_ = n[0].z;
    b1_ = n[2].z;
    k_ = 2 * pi - angle[2] - angle[3];
    solid_angle_ = std::max(0.0, angle[0] + angle[1] - k_);
}

Vec3d SphericalRectangle::point(Vec2f u) const {
    const double au = static_cast<double>(u.x) * solid_angle_ + k_, sine = std::sin(au);
    const double fu = (std::cos(au) * b0_ - b1_) / sine;
    const double cu = std::clamp(std::copysign(1 / std::sqrt(fu * fu + b0_ * b0_), fu), -1.0, 1.0);
    const double x = std::clamp(-cu * z0_ / std::sqrt(std::max(1e-300, 1 - cu * cu)), x0_, x1_);
    const double d = std::hypot(x, z0_);
    const double h0 = y0_ / std::hypot(d, y0_), h1 = y1_ / std::hypot(d, y1_);
    const double h = h0 + static_cast<double>(u.y) * (h1 - h0), h2 = h * h;
    const double y = h2 < 1 - 1e-12 ? std::clamp(h * d / std::sqrt(1 - h2), y0_, y1_) : y1_;
    return from_ + x * x_ + y * y_ + z0_ * z_;
}

SphericalTriangle::SphericalTriangle(const Vec3d& from, const Vec3d& a, const Vec3d& b,
                                     const Vec3d& c)
    : solid_angle_(triangle_solid_angle(from, a, b, c)) {
    if (!(solid_angle_ > 0)) return;
    a_ = normalize(a - from);
    b_ = normalize(b - from);
    c_ = normalize(c - from);
    // Inner angle at a, between the planes of the sides.
    alpha_ =
        std::atan2(length(cross(cross(a_, b_), cross(a_, c_))), dot(cross(a_, b_), cross(a_, c_)));
}

Vec3d SphericalTriangle::direction(Vec2f u) const {
    // The point on the side a-c that, with b, cuts off the share u.x of the area; the cosine of its
    // arc from a is q of the paper.
    const double area = static_cast<double>(u.x) * solid_angle_;
    const double ca = std::cos(alpha_), sa = std::sin(alpha_);
    const double s = std::sin(area - alpha_), t = std::cos(area - alpha_);
    const double p = t - ca, v = s + sa * dot(a_, b_);
    const double denominator = (v * s + p * t) * sa;
    double q = 1;
    if (denominator != 0) q = std::clamp(((v * t - p * s) * ca - v) / denominator, -1.0, 1.0);
    const Vec3d side = std::abs(dot(a_, c_)) < 1 ? across(c_, a_) : Vec3d{};
    const Vec3d cut = q * a_ + std::sqrt(1 - q * q) * side;
    // Then evenly in height from b towards c'.
    const double z = 1 - static_cast<double>(u.y) * (1 - dot(cut, b_));
    const Vec3d rest = cut - dot(cut, b_) * b_;
    const double l = length(rest);
    if (!(l > 0)) return b_;
    return z * b_ + (std::sqrt(std::max(0.0, 1 - z * z)) / l) * rest;
}

}  // namespace gischt
