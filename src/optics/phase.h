// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string_view>
#include <variant>

#include "base/units.h"
#include "math/vec.h"

namespace gischt {

// Phase functions: the density over the sphere (1/sr) with which a scattered photon takes a
// direction, as a function of the cosine between its old and its new direction: +1 is straight
// ahead. Each integrates to 1. Every kind has
//   float value(float cosine)   density in 1/sr; also the density of sample()
//   float sample_cosine(float u)   the cosine for u in [0,1), by inversion of the cumulative
//   double mean_cosine()
// Inner loops take the kind once: std::visit([&](const auto& phase) { ...loop... }, phase).

// Equal in all directions: 1 / (4 pi).
struct IsotropicPhase {
    float value(float) const { return static_cast<float>(0.25 / pi); }
    float sample_cosine(float u) const { return 2 * u - 1; }
    double mean_cosine() const { return 0; }
};

// (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)), g in ]-1,1[ (Henyey & Greenstein 1941). g is the
// mean cosine; g = 0 is isotropic to the last bit.
struct HenyeyGreensteinPhase {
    float g = 0;

    float value(float cosine) const {
        // 1 + g^2 - 2 g cos as a sum of positive terms, which does not cancel near g = cos = 1.
        const float d = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
        return static_cast<float>(0.25 / pi) * (1 - g) * (1 + g) / (d * std::sqrt(d));
    }
    // The textbook inversion multiplied out, so that nothing is divided by g.
    float sample_cosine(float u) const {
        const float x = 2 * u - 1, d = 1 + g * x;
        const float n = x + g * (0.5f * (3 + x * x) + g * (x + 0.5f * g * (x * x - 1)));
        return std::fmin(1.0f, std::fmax(-1.0f, n / (d * d)));
    }
    double mean_cosine() const { return static_cast<double>(g); }
};

// (1 - k^2) / (4 pi (1 - k cos)^2): the rational approximation of Blasi, Le Saec, Schlick 1993, in
// the sign convention of this file. of_g takes the k that resembles Henyey-Greenstein best.
struct SchlickPhase {
    float k = 0;

    // k = 1.55 g - 0.55 g^3.
    static SchlickPhase of_g(float g) { return {1.55f * g - 0.55f * g * g * g}; }

    float value(float cosine) const {
        const float d = 1 - k * cosine;
        return static_cast<float>(0.25 / pi) * (1 - k) * (1 + k) / (d * d);
    }
    float sample_cosine(float u) const {
        const float x = 2 * u - 1;
        return (x + k) / (1 + k * x);
    }
    double mean_cosine() const;
};

using PhaseFunction = std::variant<IsotropicPhase, HenyeyGreensteinPhase, SchlickPhase>;

// The words of a scene file: isotropic, henyey_greenstein, schlick.
enum class PhaseKind { Isotropic, HenyeyGreenstein, Schlick };

// Throws Error{Usage} unless -1 < g < 1.
PhaseFunction make_phase(PhaseKind kind, double g);

// 1/sr.
inline float value(const PhaseFunction& phase, float cosine) {
    return std::visit([cosine](const auto& p) { return p.value(cosine); }, phase);
}

struct PhaseSample {
    Vec3f direction;  // unit
    float pdf = 0;    // 1/sr; equal to the phase function's value
};

// A direction with the density of the phase function around the unit vector `forward`; u in
// [0,1)^2.
PhaseSample sample(const PhaseFunction& phase, const Vec3f& forward, Vec2f u);

double mean_cosine(const PhaseFunction& phase);

}  // namespace gischt
