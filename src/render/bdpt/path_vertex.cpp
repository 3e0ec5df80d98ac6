// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/path_vertex.h"

#include "optics/phase.h"

namespace gischt {
namespace {

// The surface as light from `direction` meets it.
Bsdf seen_from(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& direction) {
    const bool is_near = dot(direction, v.hit->normal) > 0;
    const bool is_flat = v.hit->shading_normal == v.hit->normal;
    if (is_near && is_flat) return *v.bsdf;
    SurfaceHit hit = *v.hit;
    if (!is_near) {
        hit.normal = -hit.normal;
        hit.shading_normal = -hit.shading_normal;
        hit.front = !hit.front;
    }
    if (!is_flat) {
        hit.shading_normal = valid_shading_normal(hit.shading_normal, hit.normal, direction);
    }
    return surfaces.bsdf(hit, is_near ? v.relative_ior : 1 / v.relative_ior);
}

float phase_at(const PathVertex& v, const Vec3d& a, const Vec3d& b) {
    return value(v.medium->phase(), static_cast<float>(-dot(a, b)));
}

}  // namespace

Vec3f scattering(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& eye,
                 const Vec3d& light) {
    if (v.kind == PathVertex::Kind::Medium) return v.albedo * phase_at(v, eye, light);
    if (eye == v.back) return v.bsdf->value(eye, light);
    return seen_from(surfaces, v, eye).value(eye, light);
}

double direction_density(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& from,
                         const Vec3d& to) {
    if (v.kind == PathVertex::Kind::Medium) return static_cast<double>(phase_at(v, from, to));
    if (from == v.back) return static_cast<double>(v.bsdf->pdf(from, to));
    return static_cast<double>(seen_from(surfaces, v, from).pdf(from, to));
}

Vec3f adjoint_scattering(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& eye,
                         const Vec3d& light) {
    const double before = v.facing(light);
    if (!(before > 0)) return {};
    return scattering(surfaces, v, eye, light) * static_cast<float>(v.facing(eye) / before);
}

namespace {

std::optional<PathTurn> turn_in_medium(PathVertex& v, Vec2f u, PathWeight& weight) {
    const PhaseSample s = sample(v.medium->phase(), -Vec3f(v.back), u);
    weight.weight = weight.weight * v.albedo;
    v.onward = v.return_ = static_cast<double>(s.pdf);
    return PathTurn{normalize(Vec3d(s.direction)), false};
}

// Into a single direction. Told by the discrete probability, both ways are equally likely; the
// density of the way back per solid angle is that of the way there times the ratio of the two, by
// the beam's n^2 cos dA dw, which stays.
void take_single_direction(PathVertex& v, PathFrom from, const BsdfSample& s, PathWeight& weight) {
    const double before = v.facing(v.back), after = v.facing(s.direction);
    const double squeeze = s.is_transmission ? 1 / (v.relative_ior * v.relative_ior) : 1;
    v.is_delta = true;
    v.onward = 1;
    v.return_ = squeeze * before / after;
    weight.weight = weight.weight * s.weight;
    if (from == PathFrom::Camera) return;
    // Light is carried as radiance over n^2, so per beam n^2 as much; and by the cosines to the
    // geometric normal where the shading normal tells the direction.
    const Vec3d& n = v.hit->shading_normal;
    const double bent = std::abs(dot(n, v.back) / dot(n, s.direction)) * after / before;
    weight.weight *= static_cast<float>(squeeze * bent);
}

std::optional<PathTurn> turn_at_surface(const SurfaceSet& surfaces, PathVertex& v, PathFrom from,
                                        Vec2f u, float u_lobe, PathWeight& weight) {
    const auto s = v.bsdf->sample(v.back, u, u_lobe);
    if (!s) return std::nullopt;
    if (s->is_delta) {
        take_single_direction(v, from, *s, weight);
    } else {
        if (!(s->pdf > 0)) return std::nullopt;
        v.onward = static_cast<double>(s->pdf);
        v.return_ = direction_density(surfaces, v, s->direction, v.back);
        weight.weight =
            weight.weight *
            (from == PathFrom::Camera
                 ? s->weight
                 : adjoint_scattering(surfaces, v, s->direction, v.back) * (1 / s->pdf));
    }
    return PathTurn{s->direction, s->is_transmission};
}

}  // namespace

std::optional<PathTurn> turn_at(const SurfaceSet& surfaces, PathVertex& v, PathFrom from,
                                RandomStream& random, PathWeight& weight) {
    const Vec2f u = random.leading_two();
    v.is_delta = false;
    const auto turn = v.kind == PathVertex::Kind::Medium
                          ? turn_in_medium(v, u, weight)
                          : turn_at_surface(surfaces, v, from, u, random.next(), weight);
    if (!turn || !(max_component(weight.weight) > 0)) return std::nullopt;
    return turn;
}

}  // namespace gischt
