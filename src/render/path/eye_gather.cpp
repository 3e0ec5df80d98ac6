// SPDX-License-Identifier: Apache-2.0
// What the camera sees for a method that gathers light there (EyeGather).
#include "optics/fresnel.h"
#include "optics/material.h"
#include "render/path/path_tracer.h"

namespace gischt {

void PathTracer::gather_along(const Leg& leg, const RayProfile& profile,
                              const RandomStream& random) {
    const EyeGather::Light light = gather_->along(leg.ray, profile, tracker_.media, random);
    deposit(leg.weight.value() * light.once, 1);
    deposit(leg.weight.value() * light.more, 2);
}

void PathTracer::gather_at(const Leg& leg, const SurfaceHit& hit, const Bsdf& bsdf) {
    const EyeGather::Light light = gather_->at(hit, bsdf, -leg.ray.direction);
    deposit(leg.weight.value() * light.once, 1);
    deposit(leg.weight.value() * light.more, 2);
}

// Of their own for each mirror on the way.
PixelSampler PathTracer::numbers_behind(const Leg& leg) const {
    constexpr std::uint32_t most_mirrors = 64;  // as in walk.cpp
    return sampler_.part(most_mirrors + 1, static_cast<std::uint32_t>(leg.mirrors));
}

// The first panes of glass show what they reflect and what they let through, each by its share:
// chance would make sparkles of the weaker one. False for what is no smooth glass.
bool PathTracer::see_both_ways(const Leg& leg, const SurfaceHit& hit, RandomStream random) {
    constexpr int most_panes = 2;
    const bool is_glass =
        scene_.view.surfaces.info(hit.surface).material == MaterialKind::Dielectric;
    if (!is_glass || !inside_ || leg.mirrors >= most_panes) return false;
    const double eta = inside_->at(hit).relative_ior;
    const Bsdf bsdf = scene_.view.surfaces.bsdf(hit, eta);
    if (!bsdf.is_delta_only() || eta == 1) return false;
    const Vec3d out = -leg.ray.direction;
    if (leg.mirrors == 0) {
        if (!shows(leg, hit, random)) return true;
        const Vec3f w = leg.weight.value();
        note_first((w.x + w.y + w.z) / 3,
                   {hit.point, Vec3f(leg.ray.direction), nullptr, &hit, &bsdf},
                   bsdf.albedo_estimate(out), Vec3f(hit.shading_normal));
    }
    const auto reflected =
        static_cast<float>(fresnel_dielectric(dot(out, hit.shading_normal), eta));
    const std::optional<InteriorStack> inside = inside_;
    for (const bool goes_through : {false, true}) {
        const float share = goes_through ? 1 - reflected : reflected;
        const auto way = bsdf.sample(out, {}, goes_through ? 0x1.fffffep-1f : 0.0f);
        if (share == 0 || !way || way->is_transmission != goes_through) continue;
        Leg next = leg;
        next.weight.weight = leg.weight.weight * way->weight * share;
        next.ray = leaving_ray(hit, way->direction);
        next.pdf = 0;
        next.start = leg.start * share;  // not weak by chance
        ++next.mirrors;
        if (goes_through) cross(hit);
        see(next, numbers_behind(next));
        inside_ = inside;
        take_media();
    }
    return true;
}

}  // namespace gischt
