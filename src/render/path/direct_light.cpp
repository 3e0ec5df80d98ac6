// SPDX-License-Identifier: Apache-2.0
// Light that reaches a scattering point straight from the lights, and from suns through one more
// scattering.
#include <algorithm>

#include "image/color.h"
#include "math/fast_math.h"
#include "render/path/path_tracer.h"

namespace gischt {

Vec3f PathTracer::transmittance(const Ray& ray, RandomStream& random) {
    ++rays_;
    const auto estimator = scene_.params.shadow == TransmittanceEstimator::Cached
                               ? TransmittanceEstimator::ResidualRatio
                               : scene_.params.shadow;
    return tracker_.transmittance(ray, estimator, random);
}

// Scattering so even that every direction is as good as another needs no halo.
bool PathTracer::has_halo(const Medium& medium) const {
    constexpr double least = 0.3;  // mean cosine
    return scene_.params.halo && !scene_.suns.empty() &&
           std::abs(mean_cosine(medium.phase())) > least;
}

Vec3f PathTracer::direct_light(const Vertex& v, RandomStream& random) {
    Vec3f sum;
    for (const SunSource& sun : scene_.suns) sum += from_sun(sun, v, random);
    if (!scene_.local.empty()) sum += from_local(v, random);
    if (!scene_.broad.empty()) sum += from_broad(v, random);
    return sum;
}

Vec3f PathTracer::from_sun(const SunSource& sun, const Vertex& v, RandomStream& random) {
    const LightSample s = sun.light->sample(v.point, random.two());
    if (max_component(s.weight) <= 0 || is_blocked({v.point, s.direction})) return {};
    ++rays_;
    const PhaseFunction& phase = scene_.media[v.medium]->phase();
    float weight = value(phase, dot(v.forward, Vec3f(s.direction)));
    // The way here could also have been drawn around the sun (from_halo): balance heuristic.
    if (v.halo_of) {
        const float other = value(v.halo_of->phase(), dot(v.forward, Vec3f(sun.direction)));
        weight *= v.phase_pdf / (v.phase_pdf + other);
    }
    return v.weight.value() * weight * s.weight *
           sun_transmittance(sun, v.point, s.direction, scene_.params, tracker_, random);
}

// Suns seen through one more scattering: the direction of the flight before it is drawn around the
// sun by the phase function, as that scattering will favour it. Together with from_sun() at the
// next vertex no contribution exceeds what either phase function alone would give, so a forward
// peak does not sparkle.
Vec3f PathTracer::from_halo(const Vertex& v, RandomStream random) {
    const Medium& medium = *scene_.media[v.medium];
    if (!has_halo(medium)) return {};
    const auto suns = static_cast<float>(scene_.suns.size());
    const auto pick = static_cast<std::size_t>(random.next() * suns);
    const SunSource& sun = scene_.suns[std::min(pick, scene_.suns.size() - 1)];
    const PhaseSample flight = sample(medium.phase(), Vec3f(sun.direction), random.two());
    const float pdf = value(medium.phase(), dot(v.forward, flight.direction));
    const float weight = suns * pdf / (pdf + flight.pdf);
    Ray ray{v.point, Vec3d(flight.direction)};
    if (const auto hit = scene_.view.surfaces.intersect(ray)) ray.t_max = hit->t;
    ++rays_;
    Vertex next;
    next.weight = v.weight;
    Collision end;
    if (!tracker_.fly(ray, hero_, next.weight, random, end)) return {};
    const CrossSections& cross = scene_.media[end.medium]->cross_sections();
    next.weight.weight = next.weight.weight * cross.scattering / cross.extinction();
    next.point = ray.at(end.t);
    next.forward = flight.direction;
    next.medium = end.medium;
    return weight * from_sun(sun, next, random);
}

// One light at a finite place, drawn by how brightly it would shine here.
Vec3f PathTracer::from_local(const Vertex& v, RandomStream& random) {
    float total = 0;
    for (const Light* l : scene_.local) total += luminance(l->mean_radiance(v.point));
    if (!(total > 0)) return {};
    float left = random.next() * total, share = 0;
    const Light* drawn = nullptr;
    for (const Light* l : scene_.local) {
        share = luminance(l->mean_radiance(v.point));
        if (share > 0) drawn = l;
        left -= share;
        if (left < 0) break;
    }
    const LightSample s = drawn->sample(v.point, random.two());
    if (max_component(s.weight) <= 0) return {};
    const Ray shadow{v.point, s.direction, 0, s.distance};
    if (is_blocked(shadow)) return {};
    const float phase = value(scene_.media[v.medium]->phase(), dot(v.forward, Vec3f(s.direction)));
    return v.weight.value() * (phase * total / luminance(drawn->mean_radiance(v.point))) *
           s.weight * transmittance(shadow, random);
}

// A direction drawn from a sky, weighed against the phase function that may find it as well.
Vec3f PathTracer::from_broad(const Vertex& v, RandomStream& random) {
    const auto n = static_cast<float>(scene_.broad.size());
    const auto pick = static_cast<std::size_t>(random.next() * n);
    const Light* light = scene_.broad[std::min(pick, scene_.broad.size() - 1)];
    const LightSample s = light->sample(v.point, random.two());
    if (!(s.pdf > 0) || max_component(s.weight) <= 0) return {};
    const Ray shadow{v.point, s.direction};
    if (is_blocked(shadow)) return {};
    const float phase = value(scene_.media[v.medium]->phase(), dot(v.forward, Vec3f(s.direction)));
    // The density of this direction is pdf / n, its share of the heuristic pdf / n / (pdf / n +
    // phase), and s.weight is radiance / pdf.
    const float weight = phase * n * (s.pdf / n) / (s.pdf / n + phase);
    return v.weight.value() * weight * s.weight * transmittance(shadow, random);
}

// Radiance that a path of this direction meets at infinity, with its share of the balance heuristic
// against from_broad(); `pdf` of the direction in 1/sr.
Vec3f PathTracer::from_infinity(const Vec3d& direction, float pdf) const {
    Vec3f sum = scene_.even_radiance();
    const auto n = static_cast<float>(scene_.broad.size());
    for (const Light* l : scene_.broad) {
        const Vec3f radiance = l->radiance(direction);
        if (max_component(radiance) <= 0) continue;
        sum += radiance * (pdf / (pdf + l->pdf({}, direction) / n));
    }
    return sum;
}

}  // namespace gischt
