// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "image/color.h"
#include "render/progressive.h"

namespace gischt {
namespace {

// Dimensions of a sample; from there on the streams.
enum : std::uint32_t {
    DimensionDistance = SampleDimension::Free,
    DimensionSplit,
    DimensionHero,
    DimensionTurn,  // the first turns and flights of a path
    DimensionStream = 1000
};

RandomStream stream_of(const PixelSampler& sampler, std::uint32_t branch) {
    return {sampler.stream_key(DimensionStream + branch), 0, sampler, DimensionTurn};
}

}  // namespace

PathTracer::PathTracer(const PathScene& scene, int depth) : scene_(scene), depth_(depth) {
    tracker_.media = scene.media;
    tracker_.is_grey = scene.is_grey;
    tracker_.is_emissive = scene.is_emissive;
}

TracedRay PathTracer::operator()(const Ray& camera_ray, const PixelSampler& sampler) {
    ++rays_;
    TracedRay result;
    Ray ray = camera_ray;
    const auto hit = scene_.view.surfaces.intersect(ray);
    if (hit) ray.t_max = hit->t;
    hero_ = scene_.is_grey ? 0 : static_cast<int>(3 * sampler.one(DimensionHero));
    if (scene_.params.camera == CameraSegment::Tracking) {
        see_by_tracking(ray, hit, sampler, result);
        return result;
    }
    Vec3f through(1);
    if (!scene_.media.empty()) {
        profile_.trace(scene_.media, ray, scene_.is_grey, tracker_.lookups);
        if (!profile_.is_empty()) {
            see_through_profile(ray, sampler, result);
            through = exp(-profile_.depth());
        }
    }
    float alpha = 0;
    RandomStream random = stream_of(sampler, 1);
    const float clear = luminance(through);
    if (clear > 1e-9f) result.radiance += through * seen_behind(ray, hit, random, alpha);
    if (hit) {
        result.depth += clear * static_cast<float>(hit->t);
        result.opacity += clear;
    }
    result.alpha = 1 - (through.x + through.y + through.z) / 3 * (1 - alpha);
    return result;
}

// What lies behind the media.
Vec3f PathTracer::seen_behind(const Ray& ray, const std::optional<SurfaceHit>& hit,
                              RandomStream& random, float& alpha) {
    if (!hit) {
        const BackgroundSample behind = background(scene_.view, ray.direction);
        alpha = behind.alpha;
        return behind.radiance;
    }
    alpha = 1;
    return hit->emission + follow_surface(*hit, Vec3f(ray.direction), {}, 0, random);
}

// The integral over the camera ray of transmittance times scattering times what arrives: direct
// light at all points, the rest from some of them.
void PathTracer::see_through_profile(const Ray& ray, const PixelSampler& sampler,
                                     TracedRay& result) {
    const Vec2f u = sampler.two(DimensionDistance);
    if (scene_.is_emissive) result.radiance += profile_.emission(u.y, tracker_.lookups);
    points_.clear();
    if (depth_ > 0) profile_.points(scene_.params.points, u.x, u.y, points_, tracker_.lookups);
    if (points_.empty()) return;
    RandomStream random = stream_of(sampler, 0);
    const auto vertex_at = [&](const ProfilePoint& p) {
        Vertex v;
        v.point = ray.at(p.t);
        v.forward = Vec3f(ray.direction);
        v.medium = p.medium;
        v.weight.weight = p.weight;
        return v;
    };
    for (const ProfilePoint& p : points_) {
        result.radiance += direct_light(vertex_at(p), random);
        const float share = luminance(p.weight);
        result.depth += share * static_cast<float>(p.t);
        result.opacity += share;
    }
    // Paths go on from some of the points, evenly chosen.
    const auto n = static_cast<float>(points_.size());
    const int splits = std::min(scene_.params.splits, static_cast<int>(points_.size()));
    for (int k = 0; k < splits; ++k) {
        const PixelSampler numbers =
            sampler.part(static_cast<std::uint32_t>(splits), static_cast<std::uint32_t>(k));
        const auto pick = static_cast<std::size_t>(numbers.one(DimensionSplit) * n);
        Vertex v = vertex_at(points_[std::min(pick, points_.size() - 1)]);
        v.weight.weight *= n / static_cast<float>(splits);
        random = stream_of(numbers, 2);
        result.radiance += follow(v, random);
    }
}

// The same by one random distance; noisier, and the way of a plain path tracer.
void PathTracer::see_by_tracking(const Ray& ray, const std::optional<SurfaceHit>& hit,
                                 const PixelSampler& sampler, TracedRay& result) {
    RandomStream random = stream_of(sampler, 0);
    Vertex v;
    Collision end;
    result.alpha = 1;
    if (tracker_.fly(ray, hero_, v.weight, random, end, &result.radiance)) {
        const CrossSections& cross = scene_.media[end.medium]->cross_sections();
        v.weight.weight = v.weight.weight * cross.scattering / cross.extinction();
        v.point = ray.at(end.t);
        v.forward = Vec3f(ray.direction);
        v.medium = end.medium;
        result.depth = static_cast<float>(end.t);
        result.opacity = 1;
        if (depth_ == 0) return;
        result.radiance += direct_light(v, random) + follow(v, random);
        return;
    }
    result.radiance += v.weight.value() * seen_behind(ray, hit, random, result.alpha);
    if (hit) {
        result.depth = static_cast<float>(hit->t);
        result.opacity = 1;
    }
}

bool PathTracer::survives(PathWeight& weight, RandomStream& random) const {
    const float strength = max_component(weight.value());
    const auto threshold = static_cast<float>(scene_.params.roulette);
    if (strength >= threshold) return true;
    if (random.next() * threshold >= strength) return false;
    weight.weight *= threshold / strength;
    return true;
}

Vec3f PathTracer::follow(Vertex v, RandomStream& random) {
    Vec3f sum;
    for (;;) {
        const Medium& medium = *scene_.media[v.medium];
        const bool is_last = v.events >= depth_;
        if (!is_last) sum += from_halo(v, random.branch(1));
        const PhaseSample next = sample(medium.phase(), v.forward, random.leading_two());
        Ray ray{v.point, Vec3d(next.direction)};
        ++rays_;
        const auto hit = scene_.view.surfaces.intersect(ray);
        if (hit) ray.t_max = hit->t;
        if (is_last) {
            // Only what shines by itself is still to come.
            if (!hit) {
                const Vec3f light = from_infinity(ray.direction, next.pdf);
                if (max_component(light) > 0) {
                    sum += v.weight.value() * transmittance(ray, random) * light;
                }
            }
            return sum;
        }
        Collision end;
        if (!tracker_.fly(ray, hero_, v.weight, random, end, &sum)) {
            if (hit) {
                return sum + follow_surface(*hit, next.direction, v.weight, v.events, random);
            }
            return sum + v.weight.value() * from_infinity(ray.direction, next.pdf);
        }
        const CrossSections& cross = scene_.media[end.medium]->cross_sections();
        v.weight.weight = v.weight.weight * cross.scattering / cross.extinction();
        v.halo_of = has_halo(medium) ? &medium : nullptr;
        v.phase_pdf = next.pdf;
        v.point = ray.at(end.t);
        v.forward = next.direction;
        v.medium = end.medium;
        ++v.events;
        if (!survives(v.weight, random)) return sum;
        sum += direct_light(v, random);
    }
}

Vec3f PathTracer::follow_surface(const SurfaceHit& hit, const Vec3f&, PathWeight weight, int events,
                                 RandomStream& random) {
    Vec3f sum;
    if (events > 0) sum += weight.value() * hit.emission;
    if (events >= depth_) return sum;
    // Lambert: all lights, then a direction in proportion to the cosine.
    weight.weight = weight.weight * hit.albedo;
    const auto over_pi = static_cast<float>(1 / pi);
    const auto arrives = [&](const LightSample& s, float other_pdf) {
        const auto cosine = static_cast<float>(dot(s.direction, hit.normal));
        if (cosine <= 0 || max_component(s.weight) <= 0) return Vec3f{};
        Ray shadow = leaving_ray(hit, s.direction);
        shadow.t_max = s.distance;
        if (is_blocked(shadow)) return Vec3f{};
        const float w = s.pdf > 0 && other_pdf > 0 ? s.pdf / (s.pdf + over_pi * cosine) : 1;
        return cosine * over_pi * w * s.weight * transmittance(shadow, random);
    };
    Vec3f light;
    for (const SunSource& sun : scene_.suns) {
        light += arrives(sun.light->sample(hit.point, random.two()), 0);
    }
    for (const Light* l : scene_.local) light += arrives(l->sample(hit.point, random.two()), 0);
    for (const Light* l : scene_.broad) light += arrives(l->sample(hit.point, random.two()), 1);
    sum += weight.value() * light;

    const Vec2f u = random.leading_two();
    const double r = std::sqrt(static_cast<double>(u.x)), turn = 2 * pi * static_cast<double>(u.y);
    Vec3d s, t;
    orthonormal_frame(hit.normal, s, t);
    const Vec3d out =
        r * std::cos(turn) * s + r * std::sin(turn) * t + std::sqrt(1 - r * r) * hit.normal;
    const auto pdf = over_pi * static_cast<float>(dot(out, hit.normal));
    Ray ray = leaving_ray(hit, out);
    ++rays_;
    const auto next = scene_.view.surfaces.intersect(ray);
    if (next) ray.t_max = next->t;
    if (events + 1 >= depth_) {
        if (next) return sum;
        const Vec3f infinite = from_infinity(out, pdf);
        if (max_component(infinite) > 0) {
            sum += weight.value() * transmittance(ray, random) * infinite;
        }
        return sum;
    }
    Collision end;
    if (!tracker_.fly(ray, hero_, weight, random, end, &sum)) {
        if (!next) return sum + weight.value() * from_infinity(out, pdf);
        if (!survives(weight, random)) return sum;
        return sum + follow_surface(*next, Vec3f(out), weight, events + 1, random);
    }
    Vertex v;
    const CrossSections& cross = scene_.media[end.medium]->cross_sections();
    v.weight = weight;
    v.weight.weight = v.weight.weight * cross.scattering / cross.extinction();
    v.point = ray.at(end.t);
    v.forward = Vec3f(out);
    v.medium = end.medium;
    v.events = events + 2;
    if (!survives(v.weight, random)) return sum;
    sum += direct_light(v, random);
    return sum + follow(v, random);
}

}  // namespace gischt
