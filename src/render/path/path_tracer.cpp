// SPDX-License-Identifier: Apache-2.0
// The camera's end of a path: what lies along the camera ray.
#include "render/path/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "grid/frame.h"
#include "image/color.h"
#include "math/fast_math.h"
#include "optics/material.h"
#include "render/progressive.h"

namespace gischt {
namespace {

// Dimensions of a sample; from there on the streams.
enum : std::uint32_t {
    DimensionDistance = SampleDimension::Free,
    DimensionSplit,
    DimensionHero,
    DimensionAngle,
    DimensionTurn,  // the first turns and flights of a path
    DimensionStream = 1000
};

RandomStream stream_of(const PixelSampler& sampler, std::uint32_t branch) {
    return {sampler.stream_key(DimensionStream + branch), 0, sampler, DimensionTurn};
}

float mean(const Vec3f& v) {
    return (v.x + v.y + v.z) / 3;
}

}  // namespace

PathTracer::PathTracer(const PathScene& scene, int depth, bool separates_lights)
    : scene_(scene), depth_(depth) {
    tracker_.media = scene.media_in(0);
    tracker_.is_grey = scene.is_grey;
    tracker_.is_emissive = scene.is_emissive;
    if (separates_lights) result_.of_light.resize(scene.view.lights.size());
}

const TracedRay& PathTracer::operator()(const Ray& ray, float moment, const PixelSampler& sampler) {
    ++rays_;
    std::vector<Vec3f> of_light = std::move(result_.of_light);
    std::fill(of_light.begin(), of_light.end(), Vec3f{});
    result_ = {};
    result_.of_light = std::move(of_light);
    result_.alpha = 1;
    moment_ = moment;
    sampler_ = sampler;
    camera_ray_ = ray;
    tracker_.part = scene_.part_of(moment);
    tracker_.media = scene_.media_in(tracker_.part);
    hero_ = scene_.is_grey ? 0 : static_cast<int>(3 * sampler.one(DimensionHero));
    if (scene_.has_interiors) {
        inside_.emplace(scene_.view.surfaces, ray.origin, moment);
        take_media();
    }
    Leg leg;
    leg.ray = ray;
    if (scene_.params.camera == CameraSegment::Profile) {
        see(leg, sampler);
    } else {
        RandomStream random = stream_of(sampler, 0);
        follow(leg, random);
    }
    return result_;
}

// Through boundaries on to the first surface or to infinity, with all that the media scatter and
// emit on the way.
void PathTracer::see(Leg leg, const PixelSampler& sampler) {
    constexpr int most_boundaries = 64;
    for (int i = 0; i < most_boundaries; ++i) {
        const auto hit = intersect(leg.ray, kind_of(leg));
        if (hit) leg.ray.t_max = hit->t;
        if (!tracker_.media.empty()) see_through(leg, sampler);
        if (gather_ && !tracker_.media.empty()) gather_along(leg, profile_, stream_of(sampler, 4));
        const Vec3f depth = tracker_.media.empty() ? Vec3f{} : profile_.depth();
        leg.weight.weight = leg.weight.weight * exp(-depth);
        if (luminance(leg.weight.weight) < 1e-9f) return;
        if (!hit) {
            from_infinity(leg, Vec3f(1));
            return;
        }
        if (!passes(*hit)) {
            from_surface(leg, *hit, Vec3f(1));
            return see_surface(leg, *hit, sampler);
        }
        cross(*hit);
        leg.ray = leaving_ray(*hit, leg.ray.direction);
    }
}

// Paths go on from the surface that the camera sees, several where it scatters evenly.
void PathTracer::see_surface(const Leg& leg, const SurfaceHit& hit, const PixelSampler& sampler) {
    if (gather_ && see_both_ways(leg, hit, stream_of(sampler, 1))) return;
    const bool is_even = scene_.view.surfaces.info(hit.surface).material == MaterialKind::Lambert;
    const int splits = is_even ? scene_.surface_splits : 1;
    const std::optional<InteriorStack> inside = inside_;
    for (int k = 0; k < splits; ++k) {
        RandomStream random = stream_of(
            splits == 1
                ? sampler
                : sampler.part(static_cast<std::uint32_t>(splits), static_cast<std::uint32_t>(k)),
            1);
        Leg next = leg;
        next.weight.weight *= 1 / static_cast<float>(splits);
        next.start /= static_cast<float>(splits);
        if (scatter_at_surface(next, hit, random)) {
            // In a mirror everything is gathered as it is when seen at once.
            if (gather_ && next.events == 0) {
                see(next, numbers_behind(next));
            } else {
                follow(next, random);
            }
        }
        if (splits == 1) return;
        inside_ = inside;
        take_media();
    }
}

// The integral over a stretch of the camera ray of transmittance times scattering times what
// arrives: direct light at all points, the rest from some of them.
void PathTracer::see_through(const Leg& leg, const PixelSampler& sampler) {
    profile_.trace(tracker_.media, leg.ray, scene_.is_grey, tracker_.lookups);
    if (profile_.is_empty()) return;
    const Vec2f u = sampler.two(DimensionDistance);
    if (scene_.is_emissive) {
        deposit_glow(leg.weight.value() * profile_.emission(u.y, tracker_.lookups), 0);
    }
    points_.clear();
    if (depth_ > 0) {
        profile_.points(scene_.params.points, u.x, u.y, points_, tracker_.lookups);
    }
    if (points_.empty()) return;
    see_places(leg, sampler);
    RandomStream random = stream_of(sampler, 0);
    const auto forward = Vec3f(leg.ray.direction);
    for (const ProfilePoint& p : points_) {
        Leg at = leg;
        at.weight.weight = leg.weight.weight * p.weight;
        at.events = 1;
        const Medium* medium = tracker_.media[p.medium];
        count_run(at, medium);
        const Vec3d point = leg.ray.at(p.t);
        const Vec3f albedo = medium->cross_sections().scattering /
                             max(medium->cross_sections().extinction(), Vec3f(1e-30f));
        const Scatterer here{point, forward, medium, nullptr, nullptr};
        if (leg.mirrors == 0) note_first(mean(at.weight.weight), here, albedo, {});
        direct_light(here, at, random, profile_share(p.t));
    }
    // Paths go on from some of the points, evenly chosen.
    const auto n = static_cast<float>(points_.size());
    const int splits = std::min(scene_.params.splits, static_cast<int>(points_.size()));
    const std::optional<InteriorStack> inside = inside_;
    for (int k = 0; k < splits; ++k) {
        const PixelSampler numbers =
            sampler.part(static_cast<std::uint32_t>(splits), static_cast<std::uint32_t>(k));
        const auto pick = static_cast<std::size_t>(numbers.one(DimensionSplit) * n);
        const ProfilePoint& p = points_[std::min(pick, points_.size() - 1)];
        Leg next = leg;
        next.weight.weight = leg.weight.weight * p.weight * (n / static_cast<float>(splits));
        next.start = max_component(next.weight.value());
        next.events = 1;
        count_run(next, tracker_.media[p.medium]);
        random = stream_of(numbers, 2);
        const Scatterer at{leg.ray.at(p.t), forward, tracker_.media[p.medium], nullptr, nullptr};
        if (go_on(at, next, random)) follow(next, random);
        inside_ = inside;
        take_media();
    }
}

// The light of lights at finite places at further points of the ray, which are drawn about these;
// weighed by the balance heuristic against the points of the profile.
void PathTracer::see_places(const Leg& leg, const PixelSampler& sampler) {
    const int n = scene_.params.equiangular;
    if (n == 0 || scene_.placed.empty()) return;
    angles_.aim(scene_.placed, leg.ray, profile_.begin(), profile_.end());
    if (angles_.is_empty()) return;
    const float u = sampler.one(DimensionAngle);
    RandomStream random = stream_of(sampler, 3);
    for (int i = 0; i < n; ++i) {
        const double t = angles_.sample((static_cast<float>(i) + u) / static_cast<float>(n));
        const float pdf = static_cast<float>(n) * angles_.density(t) +
                          static_cast<float>(scene_.params.points) * profile_.density(t);
        const ProfilePoint p = profile_.at(t, pdf, random.next(), tracker_.lookups);
        if (!(max_component(p.weight) > 0)) continue;
        Leg at = leg;
        at.weight.weight = leg.weight.weight * p.weight;
        at.events = 1;
        from_local(
            {leg.ray.at(t), Vec3f(leg.ray.direction), tracker_.media[p.medium], nullptr, nullptr},
            at, random);
    }
}

// What is left of their light for a point of the profile.
float PathTracer::profile_share(double t) const {
    if (scene_.params.equiangular == 0 || scene_.placed.empty() || angles_.is_empty()) return 1;
    const float here = static_cast<float>(scene_.params.points) * profile_.density(t),
                there = static_cast<float>(scene_.params.equiangular) * angles_.density(t);
    return here / (here + there);
}

// Depth, albedo, normal and motion are those of the first scattering.
void PathTracer::note_first(float share, const Scatterer& at, const Vec3f& albedo,
                            const Vec3f& normal) {
    if (shows_motion_) {
        const Vec2f motion = motion_of(at);
        result_.motion.x += share * motion.x;
        result_.motion.y += share * motion.y;
    }
    const double t = dot(at.point - camera_ray_.origin, camera_ray_.direction);
    result_.depth += share * static_cast<float>(t);
    result_.opacity += share;
    result_.albedo += share * albedo;
    result_.normal += share * normal;
}

// From half a frame before the view's time to half a frame after it, in pixels.
Vec2f PathTracer::motion_of(const Scatterer& at) const {
    const View& view = scene_.view;
    const double half = 0.5 * view.around->interval;
    const double since = (static_cast<double>(moment_) - 0.5) * view.shutter;
    if (at.hit) {
        return picture_motion(*view.around,
                              view.surfaces.carried_to(view.time - half, *at.hit, moment_),
                              view.surfaces.carried_to(view.time + half, *at.hit, moment_));
    }
    Vec3d velocity;
    if (const Field* field = scene_.velocity_of(at.medium)) {
        for (int a = 0; a < 3; ++a) velocity[a] = static_cast<double>(field->sample(at.point, a));
    }
    return picture_motion(*view.around, at.point - (half + since) * velocity,
                          at.point + (half - since) * velocity);
}

void PathTracer::deposit(const Vec3f& radiance, int events, int light) {
    result_.radiance += radiance;
    if (events == 1) result_.direct += radiance;
    if (events > 1) result_.indirect += radiance;
    if (light >= 0 && !result_.of_light.empty()) {
        result_.of_light[static_cast<std::size_t>(light)] += radiance;
    }
}

void PathTracer::deposit_glow(const Vec3f& radiance, int events) {
    deposit(radiance, events);
    if (events == 0) result_.emission += radiance;
}

void PathTracer::cross(const SurfaceHit& hit) {
    if (!inside_) return;
    inside_->cross(hit);
    take_media();
}

void PathTracer::take_media() {
    if (!inside_ || inside_->surface() < 0) {
        tracker_.media = scene_.media_in(tracker_.part);
        return;
    }
    interior_ = scene_.medium_in(tracker_.part, inside_->medium());
    tracker_.media = {&interior_, interior_ ? std::size_t{1} : 0};
}

// Boundaries that do nothing to light but change the medium.
bool PathTracer::passes(const SurfaceHit& hit) const {
    return inside_ && (scene_.view.surfaces.info(hit.surface).material == MaterialKind::None ||
                       inside_->at(hit).is_false);
}

}  // namespace gischt
