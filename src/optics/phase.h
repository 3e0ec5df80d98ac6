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
//   float sample_cosine(float u)   the cosine for u in [0,1), by inversion of the cumulative (of
//                                  one lobe after the other where it is a sum of two)
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

// Scattering by particles much smaller than the wavelength, of unpolarized light (Rayleigh 1871):
// 3 (1 + cos^2) / (16 pi).
struct RayleighPhase {
    float value(float cosine) const {
        return static_cast<float>(3 / (16 * pi)) * (1 + cosine * cosine);
    }
    // The real root of c^3 + 3 c = 8 u - 4 by Cardano.
    float sample_cosine(float u) const {
        const float q = std::fabs(4 * u - 2), a = std::cbrt(q + std::sqrt(q * q + 1));
        return std::copysign(std::fmin(1.0f, a - 1 / a), u - 0.5f);
    }
    double mean_cosine() const { return 0; }
};

// Draine's generalization of Henyey-Greenstein and Rayleigh (Draine 2003, "Scattering by
// interstellar dust grains I"): Henyey-Greenstein times (1 + alpha cos^2), normalized.
struct DrainePhase {
    float g = 0, alpha = 0;

    // Below 1e-3 |g| is set to that: the inversion is worked out around s = sqrt(1 + g^2 - 2 g
    // cos), which must move.
    static DrainePhase of(double g, double alpha);

    float value(float cosine) const {
        const float norm = 1 + alpha * (1 + 2 * g * g) / 3;
        return HenyeyGreensteinPhase{g}.value(cosine) * (1 + alpha * cosine * cosine) / norm;
    }
    // In s the cumulative is a quartic over s (Jendersie & d'Eon 2023 solve it by radicals, which
    // cancel in floating point); its root by Newton's method.
    float sample_cosine(float u) const;
    double mean_cosine() const;
};

// w HG(g1) + (1 - w) HG(g2).
struct TwoLobePhase {
    HenyeyGreensteinPhase first, second;
    float weight = 1;  // of the first

    float value(float cosine) const {
        return weight * first.value(cosine) + (1 - weight) * second.value(cosine);
    }
    float sample_cosine(float u) const {
        return u < weight ? first.sample_cosine(u / weight)
                          : second.sample_cosine((u - weight) / (1 - weight));
    }
    double mean_cosine() const;
};

// Water droplets in air in visible light: (1 - w) HG(g) + w Draine(g', alpha), fitted to 95 % of
// the Mie phase function (Jendersie & d'Eon 2023, "An approximate Mie scattering function for fog
// and cloud rendering").
struct MiePhase {
    HenyeyGreensteinPhase peak;
    DrainePhase rest;
    float weight = 0;  // of the rest

    static constexpr double least_diameter = 0.01, largest_diameter = 50;  // micrometres

    // The fit for a diameter in micrometres; 5 to 20 is what fog and clouds are made of, below 0.1
    // it is almost Rayleigh. Throws Error{Usage} outside of [least_diameter, largest_diameter].
    static MiePhase of_diameter(double micrometres);

    float value(float cosine) const {
        return (1 - weight) * peak.value(cosine) + weight * rest.value(cosine);
    }
    float sample_cosine(float u) const {
        return u < weight ? rest.sample_cosine(u / weight)
                          : peak.sample_cosine((u - weight) / (1 - weight));
    }
    double mean_cosine() const;
};

using PhaseFunction = std::variant<IsotropicPhase, HenyeyGreensteinPhase, SchlickPhase,
                                   RayleighPhase, TwoLobePhase, MiePhase>;

// The words of a scene file: isotropic, henyey_greenstein, schlick, rayleigh, two_lobe, mie.
enum class PhaseKind { Isotropic, HenyeyGreenstein, Schlick, Rayleigh, TwoLobe, Mie };

// Each kind takes what it needs.
struct PhaseParams {
    PhaseKind kind = PhaseKind::Isotropic;
    double g = 0;                  // mean cosine; of the first of two lobes
    double g2 = 0;                 // of the second lobe
    double lobe_weight = 0.5;      // of the first
    double droplet_diameter = 10;  // micrometres
};

// Throws Error{Usage} unless -1 < g, g2 < 1, lobe_weight is in [0,1] and the diameter in the range
// of the fit, each where it is used.
PhaseFunction make_phase(const PhaseParams& params);
inline PhaseFunction make_phase(PhaseKind kind, double g) {
    return make_phase(PhaseParams{.kind = kind, .g = g});
}

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
