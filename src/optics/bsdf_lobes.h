// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "math/vec.h"

namespace gischt {

class EnergyTable;            // optics/ggx_energy.h
class DielectricEnergyTable;  // optics/ggx_energy.h

struct BsdfSample {
    Vec3d direction;  // unit, to where the light comes from
    Vec3f weight;     // f |cos| / pdf; for a delta lobe its share divided by its probability
    float pdf = 0;    // 1/sr; 0 for delta
    bool is_delta = false;
    bool is_transmission = false;
};

// The scattering functions of bsdf.h in a local frame: the normal is +z, on the side of `out`
// (out.z > 0). value: f |cos| in 1/sr; pdf in 1/sr; both without delta lobes. alpha is the width of
// the GGX distribution of microfacets, 0 for a smooth surface.

// Even reflection, f = albedo / pi.
struct LambertLobe {
    Vec3f albedo;

    Vec3f value(const Vec3d& out, const Vec3d& in) const;
    float pdf(const Vec3d& out, const Vec3d& in) const;
    std::optional<BsdfSample> sample(const Vec3d& out, Vec2f u, float u_lobe) const;
    bool is_delta_only() const { return false; }
    Vec3f albedo_estimate(const Vec3d&) const { return albedo; }
};

// A metal: reflection by Fresnel's formulae for a complex index eta + i k, or by Schlick's
// approximation for a colour (then k is unused and eta is the reflectance at normal incidence).
struct ConductorLobe {
    Vec3f eta, k;
    bool is_color = false;
    double alpha = 0;
    // Gives back what a single scattering on microfacets loses (Turquin 2019); null: nothing.
    const EnergyTable* energy = nullptr;

    Vec3f value(const Vec3d& out, const Vec3d& in) const;
    float pdf(const Vec3d& out, const Vec3d& in) const;
    std::optional<BsdfSample> sample(const Vec3d& out, Vec2f u, float u_lobe) const;
    bool is_delta_only() const { return alpha == 0; }
    Vec3f albedo_estimate(const Vec3d& out) const;
    Vec3f fresnel(double cosine) const;
};

// Glass: reflection and refraction (Walter et al. 2007). `eta` is the index of refraction of the
// far side over that of the side of `out`; 1 lets light pass straight.
struct DielectricLobe {
    double eta = 1.5;
    Vec3f tint{1, 1, 1};  // factor of what passes
    double alpha = 0;
    const DielectricEnergyTable* energy = nullptr;  // as above

    Vec3f value(const Vec3d& out, const Vec3d& in) const;
    float pdf(const Vec3d& out, const Vec3d& in) const;
    std::optional<BsdfSample> sample(const Vec3d& out, Vec2f u, float u_lobe) const;
    bool is_delta_only() const { return alpha == 0 || eta == 1; }
    Vec3f albedo_estimate(const Vec3d& out) const;
};

// A clear coat over an even colour: reflection on the coat, and what passes it, scatters below it,
// is reflected to and fro between base and coat and leaves again (Kelemen & Szirmay-Kalos 2001;
// with a smooth coat exact).
struct PlasticLobe {
    Vec3f albedo;  // of the base
    double eta = 1.5;
    double alpha = 0;
    const EnergyTable* energy = nullptr;  // of the coat's reflection; needed

    Vec3f value(const Vec3d& out, const Vec3d& in) const;
    float pdf(const Vec3d& out, const Vec3d& in) const;
    std::optional<BsdfSample> sample(const Vec3d& out, Vec2f u, float u_lobe) const;
    bool is_delta_only() const { return false; }
    Vec3f albedo_estimate(const Vec3d& out) const;
    Vec3f base_value(const Vec3d& out, const Vec3d& in) const;
    double coat_chance(const Vec3d& out) const;
};

using BsdfLobe = std::variant<LambertLobe, ConductorLobe, DielectricLobe, PlasticLobe>;

}  // namespace gischt
