// SPDX-License-Identifier: Apache-2.0
#include "optics/bsdf_lobes.h"

#include <cmath>

#include "base/units.h"
#include "optics/fresnel.h"
#include "optics/ggx.h"
#include "optics/ggx_energy.h"

namespace gischt {
namespace {

float narrow(double x) {
    return static_cast<float>(x);
}

// A direction around +z in proportion to its cosine.
Vec3d cosine_direction(Vec2f u) {
    const double r = std::sqrt(static_cast<double>(u.x)), turn = 2 * pi * static_cast<double>(u.y);
    return {r * std::cos(turn), r * std::sin(turn), std::sqrt(std::fmax(0.0, 1 - r * r))};
}

float cosine_pdf(const Vec3d& in) {
    return narrow(std::fmax(0.0, in.z) / pi);
}

Vec3d mirrored(const Vec3d& out) {
    return {-out.x, -out.y, out.z};
}

// Unit half vector of a reflection.
Vec3d half_vector(const Vec3d& out, const Vec3d& in) {
    return normalize(out + in);
}

// Density of sampling `in` by reflection on visible normals, 1/sr.
double reflection_pdf(const Ggx& ggx, const Vec3d& out, const Vec3d& in) {
    const Vec3d h = half_vector(out, in);
    return ggx.visible_density(out, h) / (4 * dot(out, h));
}

// D G / (4 out.z): f |in.z| of facets that reflect all.
double reflection_value(const Ggx& ggx, const Vec3d& out, const Vec3d& in) {
    return ggx.density(half_vector(out, in)) * ggx.masking(out, in) / (4 * out.z);
}

}  // namespace

// ---- Lambert

Vec3f LambertLobe::value(const Vec3d&, const Vec3d& in) const {
    return albedo * cosine_pdf(in);
}

float LambertLobe::pdf(const Vec3d&, const Vec3d& in) const {
    return cosine_pdf(in);
}

std::optional<BsdfSample> LambertLobe::sample(const Vec3d&, Vec2f u, float) const {
    const Vec3d in = cosine_direction(u);
    if (in.z <= 0) return std::nullopt;
    return BsdfSample{in, albedo, cosine_pdf(in)};
}

// ---- Conductor

Vec3f ConductorLobe::fresnel(double cosine) const {
    Vec3f f;
    if (is_color) {
        const float rest = narrow(std::pow(1 - cosine, 5));
        return eta + (Vec3f(1) - eta) * rest;  // Schlick 1994
    }
    for (int c = 0; c < 3; ++c) {
        f[c] = narrow(
            fresnel_conductor(cosine, static_cast<double>(eta[c]), static_cast<double>(k[c])));
    }
    return f;
}

// What the light gains that meets several facets: its loss at each is that at normal incidence
// (Turquin 2019, eq. 16).
static Vec3f several_facets(const EnergyTable* energy, const Vec3f& f0, double cosine) {
    if (!energy) return Vec3f(1);
    const double e = energy->at(cosine);
    return Vec3f(1) + f0 * narrow((1 - e) / e);
}

Vec3f ConductorLobe::value(const Vec3d& out, const Vec3d& in) const {
    if (alpha == 0 || in.z <= 0) return {};
    const Ggx ggx{alpha};
    return fresnel(dot(out, half_vector(out, in))) * several_facets(energy, fresnel(1), out.z) *
           narrow(reflection_value(ggx, out, in));
}

float ConductorLobe::pdf(const Vec3d& out, const Vec3d& in) const {
    if (alpha == 0 || in.z <= 0) return 0;
    return narrow(reflection_pdf(Ggx{alpha}, out, in));
}

std::optional<BsdfSample> ConductorLobe::sample(const Vec3d& out, Vec2f u, float) const {
    if (alpha == 0) return BsdfSample{mirrored(out), fresnel(out.z), 0, true};
    const Ggx ggx{alpha};
    const Vec3d h = ggx.sample(out, u);
    const double c = dot(out, h);
    const Vec3d in = 2 * c * h - out;
    if (c <= 0 || in.z <= 0) return std::nullopt;
    const Vec3f weight = fresnel(c) * several_facets(energy, fresnel(1), out.z) *
                         narrow(ggx.masking(out, in) / ggx.masking(out));
    return BsdfSample{in, weight, narrow(reflection_pdf(ggx, out, in))};
}

Vec3f ConductorLobe::albedo_estimate(const Vec3d& out) const {
    return fresnel(out.z);
}

// ---- Dielectric

static double given_back(const DielectricEnergyTable* energy, double cosine, double eta) {
    return energy ? 1 / energy->at(cosine, eta) : 1;
}

namespace {

// The facet normal on the side of `out` that refracts `in` to `out`, and the Jacobian of it by
// `in`, in sr/sr (Walter et al. 2007, eq. 16 and 17).
struct Refraction {
    Vec3d h;
    double jacobian = 0;
    bool is_valid = false;
};

Refraction refraction(const Vec3d& out, const Vec3d& in, double eta) {
    Refraction r;
    r.h = normalize(out + eta * in);
    if (r.h.z < 0) r.h = -r.h;
    const double co = dot(out, r.h), ci = dot(in, r.h);
    if (co <= 0 || ci >= 0) return r;
    const double sum = co + eta * ci;
    r.jacobian = eta * eta * -ci / (sum * sum);
    r.is_valid = true;
    return r;
}

}  // namespace

Vec3f DielectricLobe::value(const Vec3d& out, const Vec3d& in) const {
    if (is_delta_only() || in.z == 0) return {};
    const Ggx ggx{alpha};
    const double back = given_back(energy, out.z, eta);
    if (in.z > 0) {
        const double f = fresnel_dielectric(dot(out, half_vector(out, in)), eta);
        return Vec3f(narrow(f * reflection_value(ggx, out, in) * back));
    }
    const Refraction r = refraction(out, in, eta);
    if (!r.is_valid) return {};
    const double co = dot(out, r.h), f = fresnel_dielectric(co, eta);
    const double passed =
        (1 - f) * ggx.density(r.h) * ggx.masking(out) * ggx.masking(in) * co / out.z * r.jacobian;
    return tint * narrow(passed * back);
}

float DielectricLobe::pdf(const Vec3d& out, const Vec3d& in) const {
    if (is_delta_only() || in.z == 0) return 0;
    const Ggx ggx{alpha};
    if (in.z > 0) {
        const double f = fresnel_dielectric(dot(out, half_vector(out, in)), eta);
        return narrow(f * reflection_pdf(ggx, out, in));
    }
    const Refraction r = refraction(out, in, eta);
    if (!r.is_valid) return 0;
    const double f = fresnel_dielectric(dot(out, r.h), eta);
    return narrow((1 - f) * ggx.visible_density(out, r.h) * r.jacobian);
}

std::optional<BsdfSample> DielectricLobe::sample(const Vec3d& out, Vec2f u, float u_lobe) const {
    const bool is_delta = is_delta_only();
    const Ggx ggx{alpha};
    const Vec3d h = is_delta ? Vec3d{0, 0, 1} : ggx.sample(out, u);
    const double co = dot(out, h);
    if (co <= 0) return std::nullopt;
    const double f = eta == 1 ? 0 : fresnel_dielectric(co, eta);
    BsdfSample s;
    s.is_delta = is_delta;
    s.weight = Vec3f(1);
    if (static_cast<double>(u_lobe) < f) {
        s.direction = 2 * co * h - out;
        if (s.direction.z <= 0) return std::nullopt;
    } else {
        const auto in = refracted(out, h, eta);
        if (!in || in->z >= 0) return std::nullopt;
        s.direction = *in;
        s.weight = tint;
        s.is_transmission = true;
    }
    if (is_delta) return s;
    const double shadowing = s.is_transmission ? ggx.masking(s.direction)
                                               : ggx.masking(out, s.direction) / ggx.masking(out);
    s.weight *= narrow(shadowing * given_back(energy, out.z, eta));
    s.pdf = pdf(out, s.direction);
    if (!(s.pdf > 0)) return std::nullopt;
    return s;
}

Vec3f DielectricLobe::albedo_estimate(const Vec3d& out) const {
    const float f = eta == 1 ? 0 : narrow(fresnel_dielectric(out.z, eta));
    return Vec3f(f) + (1 - f) * tint;
}

// ---- Plastic

static double coat_energy(const PlasticLobe& p, double cosine) {
    return p.alpha == 0 ? fresnel_dielectric(cosine, p.eta) : p.energy->at(cosine);
}

// Light passes the coat, is scattered by the base, is held back by the coat from inside with the
// share `inner`, and so forth; what leaves in the end has the distribution of what entered.
Vec3f PlasticLobe::base_value(const Vec3d& out, const Vec3d& in) const {
    if (in.z <= 0) return {};
    const double mean = energy->mean(), inner = 1 - (1 - mean) / (eta * eta);
    const double through =
        (1 - coat_energy(*this, out.z)) * (1 - coat_energy(*this, in.z)) / (1 - mean) * in.z / pi;
    Vec3f color;
    for (int c = 0; c < 3; ++c) {
        const double a = static_cast<double>(albedo[c]);
        color[c] = narrow(a * (1 - inner) / (1 - a * inner) * through);
    }
    return color;
}

// Chance to sample the coat: about its share of the reflected light.
double PlasticLobe::coat_chance(const Vec3d& out) const {
    const double coat = coat_energy(*this, out.z),
                 base = (1 - coat) * static_cast<double>(max_component(albedo));
    return coat / (coat + base);
}

Vec3f PlasticLobe::value(const Vec3d& out, const Vec3d& in) const {
    if (in.z <= 0) return {};
    Vec3f sum = base_value(out, in);
    if (alpha > 0) {
        const double f = fresnel_dielectric(dot(out, half_vector(out, in)), eta);
        sum += Vec3f(narrow(f * reflection_value(Ggx{alpha}, out, in)));
    }
    return sum;
}

float PlasticLobe::pdf(const Vec3d& out, const Vec3d& in) const {
    if (in.z <= 0) return 0;
    const double chance = coat_chance(out);
    const double coat = alpha > 0 ? reflection_pdf(Ggx{alpha}, out, in) : 0;
    return narrow(chance * coat + (1 - chance) * in.z / pi);
}

std::optional<BsdfSample> PlasticLobe::sample(const Vec3d& out, Vec2f u, float u_lobe) const {
    const double chance = coat_chance(out);
    BsdfSample s;
    if (static_cast<double>(u_lobe) < chance) {
        if (alpha == 0) {
            const float share = narrow(fresnel_dielectric(out.z, eta) / chance);
            return BsdfSample{mirrored(out), Vec3f(share), 0, true};
        }
        const Vec3d h = Ggx{alpha}.sample(out, u);
        s.direction = 2 * dot(out, h) * h - out;
    } else {
        s.direction = cosine_direction(u);
    }
    if (s.direction.z <= 0) return std::nullopt;
    s.pdf = pdf(out, s.direction);
    if (!(s.pdf > 0)) return std::nullopt;
    s.weight = value(out, s.direction) * (1 / s.pdf);
    return s;
}

Vec3f PlasticLobe::albedo_estimate(const Vec3d& out) const {
    const float coat = narrow(coat_energy(*this, out.z));
    return Vec3f(coat) + (1 - coat) * albedo;
}

}  // namespace gischt
