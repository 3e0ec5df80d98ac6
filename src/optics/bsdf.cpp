// SPDX-License-Identifier: Apache-2.0
#include "optics/bsdf.h"

#include <cmath>
#include <variant>

namespace gischt {
namespace {

// Sine of the least angle to a surface at which a delta lobe leaves it.
constexpr double least_slope = 1e-3;

}  // namespace

Bsdf::Bsdf(const Vec3d& normal, const Vec3d& shading_normal, const BsdfLobe& lobe)
    : n_(shading_normal), normal_(normal), lobe_(lobe) {
    orthonormal_frame(n_, s_, t_);
}

// Even reflection falls off at the edge of the facets' shadow, not of the smooth surface's; a
// polynomial lets it fade before (Chiang, Li, Burley 2019, "Taming the shadow terminator"). 1 where
// both normals agree.
double Bsdf::shadow_terminator(const Vec3d& in) const {
    if (!std::holds_alternative<LambertLobe>(lobe_) && !std::holds_alternative<PlasticLobe>(lobe_))
        return 1;
    const double bent = dot(n_, normal_);
    if (bent > 1 - 1e-12) return 1;
    const double g = dot(in, normal_) / (dot(in, n_) * bent);
    if (!(g > 0)) return 0;
    return g >= 1 ? 1 : g * (1 + g * (1 - g));
}

Vec3f Bsdf::value(const Vec3d& out, const Vec3d& in) const {
    const Vec3d o = to_local(out), i = to_local(in);
    if (o.z <= 0 || (i.z > 0) != (dot(in, normal_) > 0)) return {};
    const Vec3f f = std::visit([&](const auto& lobe) { return lobe.value(o, i); }, lobe_);
    return f * static_cast<float>(shadow_terminator(in));
}

float Bsdf::pdf(const Vec3d& out, const Vec3d& in) const {
    const Vec3d o = to_local(out), i = to_local(in);
    if (o.z <= 0 || (i.z > 0) != (dot(in, normal_) > 0)) return 0;
    return std::visit([&](const auto& lobe) { return lobe.pdf(o, i); }, lobe_);
}

std::optional<BsdfSample> Bsdf::sample(const Vec3d& out, Vec2f u, float u_lobe) const {
    const Vec3d o = to_local(out);
    if (o.z <= 0) return std::nullopt;
    auto s = std::visit([&](const auto& lobe) { return lobe.sample(o, u, u_lobe); }, lobe_);
    if (!s) return s;
    const Vec3d local = s->direction;
    s->direction = local.x * s_ + local.y * t_ + local.z * n_;
    const double side = dot(s->direction, normal_);
    if ((side < 0) != s->is_transmission || side == 0) {
        if (!s->is_delta) return std::nullopt;
        // A single direction that would run along the wrong side is bent to the right one.
        const double wanted = s->is_transmission ? -least_slope : least_slope;
        s->direction = normalize(s->direction + (wanted - side) * normal_);
    }
    if (!s->is_delta) s->weight *= static_cast<float>(shadow_terminator(s->direction));
    return s;
}

bool Bsdf::is_delta_only() const {
    return std::visit([](const auto& lobe) { return lobe.is_delta_only(); }, lobe_);
}

Vec3f Bsdf::albedo_estimate(const Vec3d& out) const {
    Vec3d o = to_local(out);
    o.z = std::fmax(o.z, 1e-3);
    return std::visit([&](const auto& lobe) { return lobe.albedo_estimate(o); }, lobe_);
}

Vec3d valid_shading_normal(const Vec3d& wish, const Vec3d& normal, const Vec3d& out) {
    // First to the side that is seen.
    Vec3d seen = wish;
    if (const double cosine = dot(out, wish); cosine < least_slope) {
        seen = normalize(wish + (least_slope - cosine) * out);
    }
    const Vec3d mirror = 2 * dot(out, seen) * seen - out;
    // At grazing incidence even the mirror on the geometric normal is low.
    const double least = std::fmin(least_slope, 0.5 * dot(out, normal));
    const double slope = dot(mirror, normal);
    if (slope >= least) return seen;
    const Vec3d half = out + normalize(mirror + (least - slope) * normal);
    return dot(half, half) > 1e-12 ? normalize(half) : normal;
}

}  // namespace gischt
