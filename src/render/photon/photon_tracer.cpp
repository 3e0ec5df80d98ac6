// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_tracer.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/sobol.h"
#include "optics/material.h"

namespace gischt {

static constexpr int most_photon_mirrors = 64;      // delta scatterings of one photon
static constexpr int most_photon_boundaries = 256;  // passed on one flight

PhotonTracer::PhotonTracer(const PhotonScene& scene, float kept_share)
    : scene_(scene), kept_share_(kept_share) {
    tracker_.is_grey = scene.path.is_grey;
}

void PhotonTracer::follow(const EmittedLight& light, float share, RandomStream random,
                          PhotonSet& out) {
    out_ = &out;
    random_ = random;
    events_ = mirrors_ = 0;
    hero_ = scene_.path.is_grey ? 0 : static_cast<int>(3 * random_.next());
    ray_ = light.hit ? leaving_ray(*light.hit, light.ray.direction) : light.ray;
    weight_ = {};
    weight_.weight = light.power * share;
    tracker_.media = scene_.path.media_in(0);
    if (scene_.path.has_interiors) {
        inside_.emplace(scene_.view.surfaces, ray_.origin);
        take_media();
        // Where the index of refraction is n the same radiance over n^2 carries n^2 times the
        // power.
        const auto n = static_cast<float>(inside_->ior());
        weight_.weight *= n * n;
    }
    for (bool goes_on = true; goes_on;) {
        Collision collision;
        std::optional<SurfaceHit> hit;
        const End end = fly(collision, hit);
        goes_on = end == End::Collision ? scatter_in_medium(collision)
                  : end == End::Surface ? scatter_at_surface(*hit)
                                        : false;
    }
}

PhotonTracer::End PhotonTracer::fly(Collision& collision, std::optional<SurfaceHit>& hit) {
    for (int i = 0; i < most_photon_boundaries; ++i) {
        hit = scene_.view.surfaces.intersect(ray_);
        if (hit) ray_.t_max = hit->t;
        if (!tracker_.media.empty() && tracker_.fly(ray_, hero_, weight_, random_, collision)) {
            return End::Collision;
        }
        if (!hit) return End::Infinity;
        if (!passes(*hit)) return End::Surface;
        cross(*hit);
        ray_ = leaving_ray(*hit, ray_.direction);
    }
    return End::Infinity;  // lost between surfaces that coincide
}

// False where the photon ends.
bool PhotonTracer::scatter_in_medium(const Collision& collision) {
    const Medium* medium = tracker_.media[collision.medium];
    const CrossSections& cross = medium->cross_sections();
    const Vec3f before = weight_.value();
    weight_.weight = weight_.weight * collision.color * cross.scattering /
                     max(cross.extinction(), Vec3f(1e-30f));
    ++events_;
    const Vec3d point = ray_.at(collision.t);
    if (is_kept(events_)) keep(out_->in_media, point, scene_.place_of(medium), events_);
    if (events_ >= scene_.depth || !survives(before)) return false;
    const PhaseSample next = sample(medium->phase(), Vec3f(ray_.direction), random_.two());
    ray_ = {point, Vec3d(next.direction)};
    return true;
}

bool PhotonTracer::scatter_at_surface(const SurfaceHit& hit) {
    const SurfaceSet& surfaces = scene_.view.surfaces;
    const Bsdf bsdf = surfaces.bsdf(hit, inside_ ? inside_->at(hit).relative_ior : 0);
    const bool may_scatter = events_ < scene_.depth;
    if (!bsdf.is_delta_only() && may_scatter && is_kept(events_ + 1)) {
        keep(out_->on_surfaces, hit.point, hit.surface, events_ + 1);
    }
    const Vec3d from = -ray_.direction;
    const Vec2f u = random_.two();
    const auto next = bsdf.sample(from, u, random_.next());
    if (!next) return false;
    const Vec3f before = weight_.value();
    weight_.weight = weight_.weight * next->weight;
    if (next->is_delta) {
        if (++mirrors_ > most_photon_mirrors) return false;
    } else {
        if (++events_ >= scene_.depth) return false;
        // Light meets the surface by the cosine of its geometry, not by that of its shading (Veach
        // 1997, 5.3).
        const double bent = dot(from, hit.normal) * dot(next->direction, hit.shading_normal),
                     straight = dot(from, hit.shading_normal) * dot(next->direction, hit.normal);
        if (bent != 0) weight_.weight *= static_cast<float>(std::abs(straight / bent));
    }
    if (!survives(before)) return false;
    if (next->is_transmission) cross(hit);
    ray_ = leaving_ray(hit, next->direction);
    return true;
}

// By the share that is not absorbed, so that photons stay alike.
bool PhotonTracer::survives(const Vec3f& before) {
    const float was = max_component(before), is = max_component(weight_.value());
    if (!(is > 0) || !std::isfinite(is)) return false;
    if (is >= was) return true;
    if (random_.next() * was >= is) return false;
    weight_.weight *= was / is;
    return true;
}

void PhotonTracer::keep(std::vector<Photon>& out, const Vec3d& point, int place, int events) {
    const auto n = static_cast<float>(inside_ ? inside_->ior() : 1);
    if (kept_share_ < 1 && random_.next() >= kept_share_) return;
    const Vec3f power = weight_.value() * (1 / (n * n * kept_share_));
    if (!(max_component(power) > 0)) return;
    out.push_back({Vec3f(point - scene_.origin), Vec3f(ray_.direction), power, place, events});
}

void PhotonTracer::cross(const SurfaceHit& hit) {
    if (!inside_) return;
    inside_->cross(hit);
    take_media();
}

void PhotonTracer::take_media() {
    if (inside_->surface() < 0) {
        tracker_.media = scene_.path.media_in(0);
        return;
    }
    interior_ = inside_->medium();
    tracker_.media = {&interior_, interior_ ? std::size_t{1} : 0};
}

bool PhotonTracer::passes(const SurfaceHit& hit) const {
    return inside_ && (scene_.view.surfaces.info(hit.surface).material == MaterialKind::None ||
                       inside_->at(hit).is_false);
}

namespace {

constexpr int chunk = 2048;  // photons that a thread takes at a time

// The numbers with which photon i of a map leaves its source: stratified but for the choice of the
// source. A stratified choice made the power of several sources together wander with the seed by
// 7 %, whatever the number of photons.
EmittedLight emitted(const LightEmission& emission, std::uint64_t key, std::uint32_t i) {
    const auto seed = [key](std::uint32_t d) { return random_bits(key, d); };
    return emission.sample(random_uniform(random_key(key, 5), i), sobol_2d(i, seed(1)),
                           sobol_2d(i, seed(2)), sobol_1d(i, seed(3)));
}

// Whether a ray is left to the photons that are aimed.
bool is_aimed(const PhotonScene& scene, const EmittedLight& light) {
    if (!scene.target) return false;
    const bool has_place =
        light.kind == EmittedLight::Kind::Surface || light.kind == EmittedLight::Kind::Volume;
    return has_place || scene.target->is_met_by(light.ray);
}

void append(PhotonSet& all, const PhotonSet& part) {
    all.in_media.insert(all.in_media.end(), part.in_media.begin(), part.in_media.end());
    all.on_surfaces.insert(all.on_surfaces.end(), part.on_surfaces.begin(), part.on_surfaces.end());
}

void trace_some(const PhotonScene& scene, const PhotonCount& all, bool aims, std::uint64_t key,
                PhotonSet& out, Job& job) {
    const std::int64_t count = aims ? all.aimed : all.everywhere;
    const LightEmission& emission = aims ? *scene.aimed : *scene.everywhere;
    const float share = 1 / static_cast<float>(count);
    const auto chunks = static_cast<int>((count + chunk - 1) / chunk);
    std::vector<PhotonSet> parts(static_cast<std::size_t>(chunks));
    parallel_ranges(chunks, 1, [&](int begin, int end) {
        PhotonTracer tracer(scene, all.kept_share);
        for (int c = begin; c < end && !job.is_cancelled(); ++c) {
            const std::int64_t first = std::int64_t{c} * chunk,
                               last = std::min(first + chunk, count);
            for (std::int64_t i = first; i < last; ++i) {
                const EmittedLight light = emitted(emission, key, static_cast<std::uint32_t>(i));
                if (light.kind == EmittedLight::Kind::None) continue;
                if (!aims && is_aimed(scene, light)) continue;
                const RandomStream random{random_key(key, static_cast<std::uint64_t>(i))};
                tracer.follow(light, share, random, parts[static_cast<std::size_t>(c)]);
            }
        }
    });
    job.check();
    for (PhotonSet& part : parts) {
        append(out, part);
        part = {};
    }
}

PhotonSet trace_with_key(const PhotonScene& scene, const PhotonCount& count, std::uint64_t key,
                         Job& job) {
    PhotonSet all;
    if (count.aimed > 0) trace_some(scene, count, true, random_key(key, 1), all, job);
    if (count.everywhere > 0) {
        trace_some(scene, count, false, random_key(key, 2), all, job);
    }
    return all;
}

PhotonCount split(const PhotonScene& scene, std::int64_t count) {
    if (!scene.aimed) return {count, 0, 1};
    const auto aimed = static_cast<std::int64_t>(scene.params.aim * static_cast<double>(count));
    return {count - aimed, aimed, 1};
}

}  // namespace

PhotonCount count_photons(const PhotonScene& scene, std::uint64_t seed, Job& job) {
    constexpr std::int64_t trial = 16'384;
    // For each photon kept so many are sent out at most: beyond, their ways take all the time. And
    // so many places of each are kept on average at most.
    constexpr double most_per_kept = 8, most_places = 16;
    const double kept = static_cast<double>(
        trace_with_key(scene, split(scene, trial), random_key(seed, 0), job).size());
    const double places = kept / static_cast<double>(trial);
    const double sent = 1 / std::clamp(places, 1 / most_per_kept, most_places);
    const double count = static_cast<double>(scene.params.photons) * sent;
    PhotonCount out = split(scene, std::max(std::int64_t{64}, static_cast<std::int64_t>(count)));
    if (places > most_places) out.kept_share = static_cast<float>(most_places / places);
    return out;
}

PhotonSet trace_photons(const PhotonScene& scene, const PhotonCount& count, std::uint64_t seed,
                        int pass, Job& job) {
    const PhaseTimer timer(job, "photons");
    return trace_with_key(scene, count, random_key(seed, static_cast<std::uint64_t>(pass) + 1),
                          job);
}

}  // namespace gischt
