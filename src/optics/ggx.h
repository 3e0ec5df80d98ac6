// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "math/vec.h"

namespace gischt {

// The GGX distribution of microfacet normals of width alpha around +z with Smith's shadowing
// (Walter et al. 2007; Heitz 2014, "Understanding the masking-shadowing function in
// microfacet-based BRDFs"). Unit vectors in the local frame; alpha > 0.
struct Ggx {
    double alpha;

    // Density of normals per projected area, 1/sr: the integral of density(h) h.z is 1.
    double density(const Vec3d& h) const {
        if (h.z <= 0) return 0;
        // In the form that keeps its digits for small alpha and h near z.
        const double a2 = alpha * alpha, s2 = h.x * h.x + h.y * h.y;
        const double e = s2 / a2 + h.z * h.z;
        return 1 / (pi * a2 * e * e);
    }
    // Smith's Lambda, for either side.
    double lambda(const Vec3d& v) const {
        const double z2 = v.z * v.z;
        if (z2 == 0) return 1e30;
        return 0.5 * (std::sqrt(1 + alpha * alpha * (v.x * v.x + v.y * v.y) / z2) - 1);
    }
    double masking(const Vec3d& v) const { return 1 / (1 + lambda(v)); }
    // Of two directions on one side, correlated by height (Heitz 2014, eq. 99).
    double masking(const Vec3d& a, const Vec3d& b) const { return 1 / (1 + lambda(a) + lambda(b)); }
    // Density of normals as seen from `out`, 1/sr (out.z > 0); integrates to 1.
    double visible_density(const Vec3d& out, const Vec3d& h) const {
        return masking(out) * std::max(0.0, dot(out, h)) * density(h) / out.z;
    }
    // A normal with that density (Heitz 2018, "Sampling the GGX distribution of visible normals",
    // by the spherical cap of Dupuy & Benyoub 2023).
    Vec3d sample(const Vec3d& out, Vec2f u) const {
        const Vec3d stretched = normalize(Vec3d{alpha * out.x, alpha * out.y, out.z});
        const double turn = 2 * pi * static_cast<double>(u.x);
        const double z = (1 - static_cast<double>(u.y)) * (1 + stretched.z) - stretched.z;
        const double r = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
        const Vec3d h = Vec3d{r * std::cos(turn), r * std::sin(turn), z} + stretched;
        return normalize(Vec3d{alpha * h.x, alpha * h.y, std::max(1e-12, h.z)});
    }
};

}  // namespace gischt
