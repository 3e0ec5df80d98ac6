// SPDX-License-Identifier: Apache-2.0
// Light that reaches a scattering point straight from the lights, and what a path meets by itself.
#include <algorithm>
#include <cmath>

#include "image/color.h"
#include "render/path/path_tracer.h"

namespace gischt {

Vec3f Scatterer::value(const Vec3d& direction) const {
    if (medium) return Vec3f(gischt::value(medium->phase(), dot(forward, Vec3f(direction))));
    return bsdf->value(-Vec3d(forward), direction);
}

float Scatterer::pdf(const Vec3d& direction) const {
    if (medium) return gischt::value(medium->phase(), dot(forward, Vec3f(direction)));
    return bsdf->pdf(-Vec3d(forward), direction);
}

std::optional<BsdfSample> Scatterer::sample(Vec2f u, RandomStream& random) const {
    if (!medium) return bsdf->sample(-Vec3d(forward), u, random.next());
    const PhaseSample s = gischt::sample(medium->phase(), forward, u);
    return BsdfSample{Vec3d(s.direction), Vec3f(1), s.pdf, false, false};
}

Ray Scatterer::leave(const Vec3d& direction, double distance) const {
    Ray ray = hit ? leaving_ray(*hit, direction) : Ray{point, direction};
    ray.t_max = distance;
    return ray;
}

// Transmittance of a shadow ray, 0 where a surface blocks it.
Vec3f PathTracer::shadow(const Scatterer& at, const Ray& ray, RandomStream& random) {
    if (is_blocked(ray)) return {};
    ++rays_;
    const TransmittanceEstimator estimator = shadow_estimator(scene_.params);
    if (!inside_) return tracker_.transmittance(ray, estimator, random);
    // From boundary to boundary, each stretch in its own medium.
    const std::optional<InteriorStack> inside = inside_;
    if (at.hit && dot(ray.direction, at.hit->normal) < 0) cross(*at.hit);
    Ray rest = ray;
    Vec3f product(1);
    for (int i = 0; i < 256; ++i) {
        const double end = rest.t_max;
        const auto hit = scene_.view.surfaces.intersect(rest, moment_);
        if (hit) rest.t_max = hit->t;
        product = product * tracker_.transmittance(rest, estimator, random);
        if (!hit) break;
        cross(*hit);
        rest = leaving_ray(*hit, ray.direction);
        rest.t_max = end - hit->t;
    }
    inside_ = inside;
    take_media();
    return product;
}

void PathTracer::direct_light(const Scatterer& at, const Leg& leg, RandomStream& random,
                              float local_share) {
    // Later scatterings of a run are reached by bridges.
    if (!at.medium || leg.run == 1 || !has_bridges(*at.medium)) {
        for (const SunSource& sun : scene_.suns) from_sun(sun, at, leg, random);
    }
    if (!scene_.local.empty()) {
        Leg local = leg;
        local.weight.weight *= local_share;
        from_local(at, local, random);
    }
    if (!scene_.broad.empty()) from_broad(at, leg, random);
    if (!scene_.glow.is_empty()) from_glow(at, leg, random);
}

void PathTracer::from_sun(const SunSource& sun, const Scatterer& at, const Leg& leg,
                          RandomStream& random) {
    const LightSample s = sun.light->sample(at.point, random.two());
    const Vec3f value = at.value(s.direction) * s.weight;
    if (max_component(value) <= 0) return;
    deposit(leg.weight.value() * value * sunlight(sun, at, s, random), leg.events, sun.index);
}

// What of a sun arrives.
Vec3f PathTracer::sunlight(const SunSource& sun, const Scatterer& at, const LightSample& s,
                           RandomStream& random) {
    const Ray ray = at.leave(s.direction, s.distance);
    if (!sun.is_cached() || inside_) return shadow(at, ray, random);
    if (is_blocked(ray)) return {};
    ++rays_;
    return sun_transmittance(sun, ray.origin, s.direction, scene_.params, tracker_, random);
}

// One light at a finite place, drawn by how brightly it would shine here.
void PathTracer::from_local(const Scatterer& at, const Leg& leg, RandomStream& random) {
    float total = 0;
    for (const auto& d : scene_.local) total += luminance(d.light->mean_radiance(at.point));
    constexpr float at_a_light = 1e15f;  // nearer than some 1e-8 m, where all sums overflow
    if (!(total > 0) || total > at_a_light) return;
    float left = random.next() * total, share = 0;
    PathScene::Drawn drawn;
    for (const auto& d : scene_.local) {
        const float here = luminance(d.light->mean_radiance(at.point));
        if (here > 0) {
            drawn = d;
            share = here / total;
        }
        left -= here;
        if (left < 0) break;
    }
    const LightSample s = drawn.light->sample(at.point, random.two());
    if (max_component(s.weight) <= 0) return;
    Vec3f value = at.value(s.direction) * (1 / share);
    if (max_component(value) <= 0) return;
    // A light with a size may also be met by chance.
    if (s.pdf > 0) value *= share * s.pdf / (share * s.pdf + at.pdf(s.direction));
    deposit(leg.weight.value() * value * s.weight *
                shadow(at, at.leave(s.direction, s.distance), random),
            leg.events, drawn.index);
}

// The chance with which a sky is looked for at a point. Walks through a medium find an even sky by
// themselves; a direction drawn from it costs a shadow ray through the medium.
float PathTracer::sky_chance(const Scatterer& at) const {
    return at.medium ? scene_.sky_chance : 1;
}

// A direction drawn from a sky, weighed against the scattering that may find it as well.
void PathTracer::from_broad(const Scatterer& at, const Leg& leg, RandomStream& random) {
    const float chance = sky_chance(at);
    if (chance < 1 && random.next() >= chance) return;
    const auto n = static_cast<float>(scene_.broad.size());
    const auto pick = static_cast<std::size_t>(random.next() * n);
    const PathScene::Drawn& drawn = scene_.broad[std::min(pick, scene_.broad.size() - 1)];
    const LightSample s = drawn.light->sample(at.point, random.two());
    if (!(s.pdf > 0) || max_component(s.weight) <= 0) return;
    const Vec3f value = at.value(s.direction);
    if (max_component(value) <= 0) return;
    const float weight = s.pdf / (chance * s.pdf / n + at.pdf(s.direction));
    deposit(leg.weight.value() * weight * value * s.weight *
                shadow(at, at.leave(s.direction, s.distance), random),
            leg.events, drawn.index);
}

// What a path meets at infinity. The camera sees the background; what was drawn by a density is
// weighed against from_broad(), and suns are left to from_sun(); mirrors show all.
void PathTracer::from_infinity(const Leg& leg, const Vec3f& transmittance) {
    const Vec3f weight = leg.weight.value() * transmittance;
    const Vec3d& direction = leg.ray.direction;
    if (leg.events == 0 && leg.mirrors == 0) {
        const BackgroundSample behind = background(scene_.view, direction);
        deposit(weight * behind.radiance, 0);
        result_.alpha -= (weight.x + weight.y + weight.z) / 3 * (1 - behind.alpha);
        result_.transmittance += weight;
        return;
    }
    for (const auto& d : scene_.even) {
        deposit(weight * d.light->radiance(direction), leg.events, d.index);
    }
    const auto n = static_cast<float>(scene_.broad.size());
    for (const auto& d : scene_.broad) {
        const Vec3f radiance = d.light->radiance(direction);
        if (max_component(radiance) <= 0) continue;
        const float share =
            leg.pdf > 0
                ? leg.pdf / (leg.pdf + leg.sky_chance * d.light->pdf(leg.from, direction) / n)
                : 1;
        deposit(share * weight * radiance, leg.events, d.index);
    }
    if (leg.pdf > 0) return;
    for (const SunSource& sun : scene_.suns) {
        deposit(weight * sun.light->radiance(direction), leg.events, sun.index);
    }
}

// The glow of a surface that a path meets, weighed against from_local().
void PathTracer::from_surface(const Leg& leg, const SurfaceHit& hit, const Vec3f& transmittance) {
    if (max_component(hit.emission) <= 0) return;
    float weight = 1;
    const SurfaceLight* light = scene_.surface_light[static_cast<std::size_t>(hit.surface)];
    if (leg.pdf > 0 && light) {
        const float other = scene_.local_share(*light, leg.from) * light->pdf_of_hit(leg.from, hit);
        weight = leg.pdf / (leg.pdf + other);
    }
    deposit_glow(weight * leg.weight.value() * transmittance * hit.emission, leg.events);
}

// The share of the light of suns and sampled lights that does not arrive at a surface.
float PathTracer::missed_light(const Scatterer& at, RandomStream& random) {
    float all = 0, arrives = 0;
    const auto add = [&](const LightSample& s) {
        const Vec3f light = at.value(s.direction) * s.weight;
        if (!(max_component(light) > 0)) return;
        all += luminance(light);
        arrives += luminance(light * shadow(at, at.leave(s.direction, s.distance), random));
    };
    for (const SunSource& sun : scene_.suns) add(sun.light->sample(at.point, random.two()));
    for (const auto& d : scene_.local) add(d.light->sample(at.point, random.two()));
    for (const auto& d : scene_.broad) add(d.light->sample(at.point, random.two()));
    for (const auto& d : scene_.even) add(d.light->sample(at.point, random.two()));
    return all > 0 ? std::clamp(1 - arrives / all, 0.0f, 1.0f) : 0;
}

}  // namespace gischt
