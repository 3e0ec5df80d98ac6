// SPDX-License-Identifier: Apache-2.0
// A path from scattering to scattering.
#include <algorithm>

#include "optics/material.h"
#include "render/path/path_tracer.h"

namespace gischt {

static constexpr int most_mirrors = 64;      // delta scatterings of one path
static constexpr int most_boundaries = 256;  // passed on one leg

void PathTracer::follow(Leg leg, RandomStream& random) {
    for (;;) {
        Collision collision;
        std::optional<SurfaceHit> hit;
        const bool is_last = leg.events >= depth_;
        // What comes after the last scattering is only looked at, without a chance to collide,
        // unless there is a glow to be met on the way.
        const End end = is_last && !scene_.is_emissive ? look(leg, random, hit)
                                                       : fly(leg, random, collision, hit);
        if (end == End::Infinity) return from_infinity(leg, Vec3f(1));
        if (end == End::Collision) {
            if (is_last || !scatter_in_medium(leg, collision, random)) return;
            continue;
        }
        from_surface(leg, *hit, Vec3f(1));
        if (gather_ && leg.events > 0) return;
        if (!scatter_at_surface(leg, *hit, random)) return;
    }
}

// On to the next collision with a medium, surface, or infinity. Light emitted on the way counts.
PathTracer::End PathTracer::fly(Leg& leg, RandomStream& random, Collision& collision,
                                std::optional<SurfaceHit>& hit) {
    for (int i = 0; i < most_boundaries; ++i) {
        hit = intersect(leg.ray, kind_of(leg));
        if (hit) leg.ray.t_max = hit->t;
        if (!tracker_.media.empty()) {
            Vec3f glow;
            const bool collides =
                tracker_.fly(leg.ray, hero_, leg.weight, random, collision, &glow);
            if (max_component(glow) > 0) {
                deposit_glow(glow_share(leg, hit.has_value()) * glow, leg.events);
            }
            if (collides) return End::Collision;
        }
        if (!hit) return End::Infinity;
        if (!passes(*hit)) return End::Surface;
        cross(*hit);
        leg.ray = leaving_ray(*hit, leg.ray.direction);
    }
    leg.weight.weight = {};  // lost between surfaces that coincide
    return End::Infinity;
}

// The same without collisions, the media dimming the light by their transmittance.
PathTracer::End PathTracer::look(Leg& leg, RandomStream& random, std::optional<SurfaceHit>& hit) {
    for (int i = 0; i < most_boundaries; ++i) {
        hit = intersect(leg.ray, kind_of(leg));
        if (hit) leg.ray.t_max = hit->t;
        const bool is_dark = !hit && scene_.even.empty() && scene_.broad.empty() && leg.pdf > 0;
        if (!tracker_.media.empty() && !is_dark) {
            leg.weight.weight =
                leg.weight.weight *
                tracker_.transmittance(leg.ray, shadow_estimator(scene_.params), random);
        }
        if (!hit) return End::Infinity;
        if (!passes(*hit)) return End::Surface;
        cross(*hit);
        leg.ray = leaving_ray(*hit, leg.ray.direction);
    }
    leg.weight.weight = {};
    return End::Infinity;
}

// False where the path ends.
bool PathTracer::scatter_in_medium(Leg& leg, const Collision& collision, RandomStream& random) {
    const Medium* medium = tracker_.media[collision.medium];
    const CrossSections& cross = medium->cross_sections();
    const Vec3d point = leg.ray.at(collision.t);
    const Vec3f albedo =
        collision.color * cross.scattering / max(cross.extinction(), Vec3f(1e-30f));
    const Scatterer at{point, Vec3f(leg.ray.direction), medium, nullptr, nullptr};
    if (leg.events == 0 && leg.mirrors == 0) note_first(1, at, albedo, {});
    // fly() counted the extinction of each channel over that of the hero.
    leg.weight.weight = leg.weight.weight * albedo;
    ++leg.events;
    count_run(leg, medium);
    if (!survives(leg, random)) return false;
    direct_light(at, leg, random);
    return go_on(at, leg, random);
}

// Leaves a point of a medium in a new direction. False where the path ends.
bool PathTracer::go_on(const Scatterer& at, Leg& leg, RandomStream& random) {
    if (has_bridges(*at.medium)) set_out_bridges(at, leg, random.branch(1));
    leg.from = at.point;
    leg.sky_chance = sky_chance(at);
    return turn(at, leg, random).has_value();
}

void PathTracer::count_run(Leg& leg, const Medium* medium) {
    leg.run = leg.run_in == medium ? leg.run + 1 : 1;
    leg.run_in = medium;
}

// False where the path ends.
bool PathTracer::scatter_at_surface(Leg& leg, const SurfaceHit& hit, RandomStream& random) {
    const bool is_first = leg.events == 0 && leg.mirrors == 0;
    if (is_first && !shows(leg, hit, random)) return false;
    const Bsdf bsdf = scene_.view.surfaces.bsdf(hit, inside_ ? inside_->at(hit).relative_ior : 0);
    const Scatterer at{hit.point, Vec3f(leg.ray.direction), nullptr, &hit, &bsdf};
    if (is_first) {
        const Vec3f w = leg.weight.value();
        note_first((w.x + w.y + w.z) / 3, at, bsdf.albedo_estimate(-leg.ray.direction),
                   Vec3f(hit.shading_normal));
    }
    if (!bsdf.is_delta_only()) {
        if (leg.events >= depth_) return false;
        Leg lit = leg;
        ++lit.events;
        direct_light(at, lit, random);
        if (gather_ && leg.events == 0) gather_at(leg, hit, bsdf);
    }
    const auto next = turn(at, leg, random);
    if (!next) return false;
    leg.run_in = nullptr;
    if (next->is_delta) {
        if (++leg.mirrors > most_mirrors) return false;
    } else {
        ++leg.events;
        leg.from = hit.point;
        leg.sky_chance = 1;
    }
    if (next->is_transmission) cross(hit);
    return survives(leg, random);
}

// Holdouts cut a hole; shadow catchers show what light they miss, as alpha.
bool PathTracer::shows(const Leg& leg, const SurfaceHit& hit, RandomStream& random) {
    const SurfaceInfo& info = scene_.view.surfaces.info(hit.surface);
    if (!info.holdout && !info.shadow_catcher) return true;
    const Vec3f w = leg.weight.value();
    float shown = 1;
    if (info.shadow_catcher) {
        const Bsdf bsdf = scene_.view.surfaces.bsdf(hit);
        shown = missed_light({hit.point, Vec3f(leg.ray.direction), nullptr, &hit, &bsdf}, random);
        shown = 1 - shown;
    }
    result_.alpha -= (w.x + w.y + w.z) / 3 * shown;
    return false;
}

bool PathTracer::survives(Leg& leg, RandomStream& random) const {
    const float strength = max_component(leg.weight.value());
    const float threshold = static_cast<float>(scene_.params.roulette) * leg.start;
    if (strength >= threshold) return true;
    if (random.next() * threshold >= strength) return false;
    leg.weight.weight *= threshold / strength;
    return true;
}

}  // namespace gischt
