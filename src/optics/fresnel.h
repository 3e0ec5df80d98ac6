// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "math/vec.h"

namespace gischt {

// Share of unpolarized light that a smooth boundary reflects. `cosine` in [0,1] is that of the
// angle of incidence, `eta` the index of refraction of the far side over that of the near side;
// 1 for total reflection (Pharr, Jakob, Humphreys 2023, Physically Based Rendering, 9.3.5).
inline double fresnel_dielectric(double cosine, double eta) {
    const double sine2 = (1 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1) return 1;
    const double cosine_t = std::sqrt(1 - sine2);
    const double parallel = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    const double perpendicular = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// The same for a metal of complex index eta + i k against vacuum (Born & Wolf 1999, 14.2).
inline double fresnel_conductor(double cosine, double eta, double k) {
    const double c2 = cosine * cosine, s2 = 1 - c2;
    const double t0 = eta * eta - k * k - s2;
    const double a2_b2 = std::sqrt(t0 * t0 + 4 * eta * eta * k * k);
    const double a = std::sqrt(std::fmax(0.0, 0.5 * (a2_b2 + t0)));
    const double t1 = a2_b2 + c2, t2 = 2 * a * cosine;
    const double perpendicular = (t1 - t2) / (t1 + t2);
    const double t3 = c2 * a2_b2 + s2 * s2, t4 = t2 * s2;
    const double parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5 * (parallel + perpendicular);
}

// Direction of the refracted light for a unit vector `out` and a unit normal on its side, both
// pointing away from the boundary; nothing for total reflection. Exactly -out for eta = 1.
inline std::optional<Vec3d> refracted(const Vec3d& out, const Vec3d& normal, double eta) {
    if (eta == 1) return -out;
    const double cosine = dot(out, normal);
    const double sine2 = std::fmax(0.0, 1 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1) return std::nullopt;
    const double cosine_t = std::sqrt(1 - sine2);
    return normalize((cosine / eta - cosine_t) * normal - out / eta);
}

}  // namespace gischt
