// SPDX-License-Identifier: Apache-2.0
// Media that glow, as lights: drawn from, met by chance, and headed for.
#include <limits>

#include "optics/material.h"
#include "render/path/path_tracer.h"

namespace gischt {

static constexpr double endless = std::numeric_limits<double>::infinity();

// To a point that glows; 0 where none was drawn.
Vec3d PathTracer::way_to_glow(const Scatterer& at, RandomStream& random) const {
    const float choice = random.next();
    const Vec2f place = random.two();
    const EmissionSample s =
        scene_.glow.sample(at.point, choice, {place.x, place.y, random.next()});
    return s.pdf > 0 ? s.point - at.point : Vec3d{};
}

// The share of paths that head for what glows when they are scattered. They meet not only the glow,
// which is sampled anyway, but also what it lights: the smoke next to it, which a path from the
// ground rarely finds by chance. Within media it does not pay.
float PathTracer::lean_to_glow(const Scatterer& at) const {
    if (scene_.glow.is_empty() || at.medium) return 0;
    const MaterialKind kind = scene_.view.surfaces.info(at.hit->surface).material;
    return kind == MaterialKind::Lambert ? 0.5f : 0;
}

// Takes a new direction, and what it weighs. Nothing where the path ends.
std::optional<BsdfSample> PathTracer::turn(const Scatterer& at, Leg& leg, RandomStream& random) {
    const Vec2f u = random.leading_two();
    const float lean = lean_to_glow(at);
    std::optional<BsdfSample> next;
    if (lean > 0 && random.next() < lean) {
        const Vec3d way = way_to_glow(at, random);
        const Vec3d direction = way / length(way);
        const float pdf = at.pdf(direction);
        if (pdf > 0) next = {direction, at.value(direction) / pdf, pdf, false, false};
    } else {
        next = at.sample(u, random);
    }
    if (!next) return next;
    leg.weight.weight = leg.weight.weight * next->weight;
    leg.ray = at.leave(next->direction, endless);
    leg.pdf = next->pdf;
    if (!next->is_delta && !scene_.glow.is_empty()) {
        leg.glow = scene_.glow.direction_pdf(leg.ray);
        const float share = leg.pdf / ((1 - lean) * leg.pdf + lean * leg.glow);
        leg.weight.weight *= share;
        leg.start *= share;  // a path that was sought on purpose is not weak
    }
    return next;
}

// The direction of a point that glows, and all that glows along it; weighed by the balance
// heuristic against the paths that may take it.
void PathTracer::from_glow(const Scatterer& at, const Leg& leg, RandomStream& random) {
    const Vec3d way = way_to_glow(at, random);
    const double distance = length(way);
    if (!(distance > 0)) return;
    const Vec3d direction = way / distance;
    const Vec3f value = at.value(direction);
    if (max_component(value) <= 0) return;
    Ray ray = at.leave(direction, endless);
    if (const auto hit = intersect(ray)) {
        ray.t_max = hit->t;
        if (distance > ray.t_max) return;  // behind a surface, where the density does not count it
    }
    const float pdf = scene_.glow.direction_pdf(ray);
    if (!(pdf > 0)) return;
    const float share = 1 / (pdf + at.pdf(direction));
    Vec3f glow;
    if (at.hit && leg.events == 1) {  // seen by the camera: nothing is left to chance but the place
        glow_profile_.trace(tracker_.media, ray, scene_.is_grey, tracker_.lookups);
        glow = leg.weight.value() * glow_profile_.emission(random.next(), tracker_.lookups);
    } else {
        PathWeight weight = leg.weight;
        Collision end;
        tracker_.fly(ray, hero_, weight, random, end, &glow);
    }
    deposit(share * value * glow, leg.events);
}

// The share of what glows on a leg, against from_glow().
float PathTracer::glow_share(const Leg& leg, bool is_cut) const {
    if (leg.pdf == 0 || scene_.glow.is_empty()) return 1;
    return leg.pdf / (leg.pdf + (is_cut ? scene_.glow.direction_pdf(leg.ray) : leg.glow));
}

}  // namespace gischt
