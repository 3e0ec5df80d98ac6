// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/subpath_tracer.h"

#include <algorithm>
#include <limits>

#include "math/fast_math.h"
#include "optics/material.h"
#include "render/bdpt/light_choice.h"
#include "render/bdpt/strategy_weights.h"

namespace gischt {
namespace {

constexpr int most_deltas = 64;       // turns into single directions of one subpath
constexpr int most_boundaries = 256;  // passed between two vertices
constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace

SubpathTracer::SubpathTracer(const BdptScene& scene, int depth) : scene_(scene), depth_(depth) {
    tracker_.media = scene.path.media_in(0);
    tracker_.is_grey = scene.path.is_grey;
    tracker_.is_emissive = scene.path.is_emissive;
}

void SubpathTracer::from_camera(const Ray& ray, double density, int hero, RandomStream& random,
                                const Length& length, Subpath& path) {
    path.clear();
    PathVertex& eye = path.vertices.emplace_back();
    eye.kind = PathVertex::Kind::Camera;
    eye.point = ray.origin;
    eye.onward = density;
    enter(scene_.path.has_interiors
              ? std::optional<InteriorStack>(std::in_place, scene_.view.surfaces, ray.origin)
              : std::nullopt);
    eye.inside = inside_;
    Leg leg;
    leg.ray = ray;
    leg.hero = hero;
    leg.density = density;
    leg.is_place = scene_.view.camera.projection() == Projection::Orthographic;
    walk(leg, random, length, path);
}

void SubpathTracer::from_light(const LightNumbers& start, int hero, RandomStream& random,
                               const Length& length, Subpath& path) {
    using Kind = EmittedLight::Kind;
    path.clear();
    if (!scene_.emission || depth_ == 0) return;
    const EmittedLight e =
        scene_.emission->sample(start.choice, start.place, start.direction, start.extra);
    if (e.kind == Kind::None) return;
    const bool is_far = e.kind == Kind::Infinity;
    PathVertex& light = path.vertices.emplace_back();
    light.kind = PathVertex::Kind::Light;
    light.light = e.kind;
    light.source = e.source;
    light.point = e.hit ? e.hit->point : e.ray.origin;
    light.back = -e.ray.direction;
    light.hit = e.hit;
    light.medium = e.medium;
    light.is_delta = is_far && !(e.pdf_direction > 0);
    const float first = is_far ? e.pdf_direction : e.pdf_place;
    light.density = static_cast<double>(e.choice) * (first > 0 ? static_cast<double>(first) : 1);
    light.onward = static_cast<double>(is_far ? e.pdf_place : e.pdf_direction);
    light.earlier = 0;
    Leg leg;
    leg.from = PathFrom::Light;
    leg.ray = e.hit ? leaving_ray(*e.hit, e.ray.direction) : e.ray;
    leg.hero = hero;
    leg.weight.weight = e.power;
    leg.start = max_component(e.power);
    leg.density = light.onward;
    leg.is_place = is_far;
    std::optional<InteriorStack> inside;
    if (scene_.path.has_interiors) {
        if (is_far) {
            inside.emplace(scene_.view.surfaces);
        } else {
            inside.emplace(scene_.view.surfaces, leg.ray.origin);
        }
    }
    enter(inside);
    light.inside = inside_;
    walk(leg, random, length, path);
}

void SubpathTracer::walk(Leg leg, RandomStream& random, const Length& length, Subpath& path) {
    while (path.vertices.size() < length.most_vertices && step(leg, random, length, path)) {
    }
}

// To the next vertex and on from it; false where the path ends.
bool SubpathTracer::step(Leg& leg, RandomStream& random, const Length& length, Subpath& path) {
    PathVertex next;
    leg.through = 1;
    const std::size_t number = path.vertices.size();
    if (random.source) random.source->begin(2 * number);
    if (!fly(leg, random, path, next)) return false;
    if (!place_density(leg, path, next)) return false;
    next.weight = leg.weight;
    next.events = leg.events;
    next.inside = inside_;
    next.through = leg.through;
    // Sums of the strategies that end before the vertex before.
    next.earlier = strategies_before(scene_, path.vertices, path.vertices.back().return_, false);
    path.vertices.push_back(std::move(next));
    if (leg.from == PathFrom::Light && path.vertices.size() == 2) finish_light_start(path);
    if (random.source) random.source->begin(2 * number + 1);
    return turn(leg, random, length, path);
}

// How the light would be sampled from the first vertex after it.
void SubpathTracer::finish_light_start(Subpath& path) {
    PathVertex& light = path.vertices[0];
    PathVertex& first = path.vertices[1];
    const LightEnd end = light_end_of(scene_, light, first.point);
    // The density of a direction of a picture leaps from texel to texel: by rounding it may be
    // another one than that of the sample.
    if (light.light == EmittedLight::Kind::Infinity && end.emitted.direction > 0) {
        light.density =
            static_cast<double>(end.emitted.choice) * static_cast<double>(end.emitted.direction);
    }
    double sampled = end.sampled;
    const bool is_converted = light.light == EmittedLight::Kind::Surface;
    if (is_converted) sampled *= end.facing / (end.distance * end.distance);
    first.sampled = sampled / light.density;
}

bool SubpathTracer::place_density(const Leg& leg, const Subpath& path, PathVertex& next) const {
    const PathVertex& last = path.vertices.back();
    double d2 = 1;
    if (!leg.is_place) {
        const Vec3d way = next.point - last.point;
        d2 = dot(way, way);
    }
    next.density = leg.density * next.facing(next.back) / d2;
    return next.density > 0 && std::isfinite(next.density);
}

// False where there is no vertex any more. Emission on the way and the way out are noted.
bool SubpathTracer::fly(Leg& leg, RandomStream& random, Subpath& path, PathVertex& next) {
    const bool is_camera = leg.from == PathFrom::Camera;
    const bool is_first = is_camera && path.vertices.size() == 1;
    const bool is_last = leg.events >= depth_;
    // What the camera's path meets after its last scattering is only looked at, unless something
    // glows on the way.
    const bool looks = is_last && is_camera && !scene_.path.is_emissive;
    for (int i = 0; i < most_boundaries; ++i) {
        const auto hit = intersect(leg.ray, is_first ? RayKind::Camera : RayKind::Other);
        if (hit) leg.ray.t_max = hit->t;
        if (!tracker_.media.empty()) {
            Collision collision;
            bool collides = false;
            if (looks) {
                leg.weight.weight = leg.weight.weight *
                                    tracker_.transmittance(leg.ray, scene_.params.shadow, random);
            } else {
                Vec3f glow;
                met_.clear();
                tracker_.glows = is_camera ? &met_ : nullptr;
                collides = tracker_.fly(leg.ray, leg.hero, leg.weight, random, collision,
                                        is_camera ? &glow : nullptr);
                if (!met_.empty()) note_glows(leg, path);
            }
            if (collides) {
                Ray passed = leg.ray;
                passed.t_max = collision.t;
                leg.through *= expected_transmittance(passed);
                const Medium* medium = tracker_.media[collision.medium];
                const CrossSections& cross = medium->cross_sections();
                next.kind = PathVertex::Kind::Medium;
                next.point = leg.ray.at(collision.t);
                next.back = -leg.ray.direction;
                next.medium = medium;
                next.albedo =
                    collision.color * cross.scattering / max(cross.extinction(), Vec3f(1e-30f));
                return !is_last;
            }
        }
        leg.through *= expected_transmittance(leg.ray);
        if (!hit) {
            if (is_camera) path.escape = {leg.ray.direction, leg.weight, leg.through};
            return false;
        }
        if (!passes(*hit)) {
            next.kind = PathVertex::Kind::Surface;
            next.point = hit->point;
            next.back = -leg.ray.direction;
            next.hit = *hit;
            next.relative_ior = relative_ior(*hit);
            next.bsdf.emplace(scene_.view.surfaces.bsdf(*hit, next.relative_ior));
            return true;
        }
        cross(*hit);
        leg.ray = leaving_ray(*hit, leg.ray.direction);
    }
    return false;  // lost between surfaces that coincide
}

void SubpathTracer::note_glows(const Leg& leg, Subpath& path) {
    for (const GlowOnWay& g : met_) {
        Ray passed = leg.ray;
        passed.t_max = g.t;
        path.glows.push_back({path.vertices.size() - 1, leg.ray.at(g.t), tracker_.media[g.medium],
                              g.radiance, leg.through * expected_transmittance(passed)});
    }
}

// From the last vertex into a new direction.
bool SubpathTracer::turn(Leg& leg, RandomStream& random, const Length& length, Subpath& path) {
    PathVertex& v = path.vertices.back();
    if (path.vertices.size() >= length.most_vertices) return false;
    if (length.has_roulette && !survives(leg, random)) return false;
    const auto next = turn_at(scene_.view.surfaces, v, leg.from, random, leg.weight);
    if (!next) return false;
    if (v.is_delta) {
        if (++leg.deltas > most_deltas) return false;
    } else {
        ++leg.events;
    }
    // The light of a path that was scattered so often reaches nothing but the camera's film.
    if (leg.events > depth_ || (leg.from == PathFrom::Light && leg.events >= depth_)) return false;
    leg.ray = leave(v, next->direction);
    leg.density = v.onward;
    leg.is_place = false;
    if (next->is_transmission) cross(*v.hit);
    return true;
}

bool SubpathTracer::survives(Leg& leg, RandomStream& random) const {
    const float strength = max_component(leg.weight.value());
    const float threshold = static_cast<float>(scene_.params.roulette) * leg.start;
    if (strength >= threshold) return true;
    if (random.next() * threshold >= strength) return false;
    leg.weight.weight *= threshold / strength;
    return true;
}

Ray SubpathTracer::leave(const PathVertex& v, const Vec3d& direction) {
    return v.hit ? leaving_ray(*v.hit, direction) : Ray{v.point, direction};
}

SubpathTracer::Passage SubpathTracer::passage(const PathVertex& v, const Ray& ray, RayKind kind,
                                              int target) {
    Passage p;
    if (!scene_.path.has_interiors && target < 0 && kind == RayKind::Other) {
        ++rays_;
        if (scene_.view.surfaces.is_blocked(ray)) return p;
        p.is_open = true;
        p.through = expected_transmittance(ray);
        return p;
    }
    enter(v.inside);
    if (v.hit && dot(ray.direction, v.hit->normal) < 0) cross(*v.hit);
    Ray rest = ray;
    if (target >= 0) rest.t_max = endless;
    for (int i = 0; i < most_boundaries; ++i) {
        const double end = rest.t_max;
        const auto hit = intersect(rest, kind);
        if (hit) rest.t_max = hit->t;
        p.through *= expected_transmittance(rest);
        if (!hit) {
            p.is_open = target < 0;
            return p;
        }
        if (!passes(*hit)) {
            if (hit->surface != target) return p;
            p.reached = hit;
            p.is_open = true;
            return p;
        }
        p.has_boundaries = true;
        cross(*hit);
        rest = leaving_ray(*hit, ray.direction);
        rest.t_max = end - hit->t;
    }
    return p;
}

Vec3f SubpathTracer::transmittance(const PathVertex& v, const Ray& ray, const Passage& passage,
                                   RandomStream& random) {
    enter(v.inside);
    if (v.hit && dot(ray.direction, v.hit->normal) < 0) cross(*v.hit);
    if (!passage.has_boundaries) {
        return tracker_.transmittance(ray, scene_.params.shadow, random);
    }
    // From boundary to boundary, each stretch in its own medium.
    Ray rest = ray;
    Vec3f product(1);
    for (int i = 0; i < most_boundaries; ++i) {
        const double end = rest.t_max;
        const auto hit = scene_.view.surfaces.intersect(rest);
        if (hit) rest.t_max = hit->t;
        product = product * tracker_.transmittance(rest, scene_.params.shadow, random);
        if (!hit) break;
        cross(*hit);
        rest = leaving_ray(*hit, ray.direction);
        rest.t_max = end - hit->t;
    }
    return product;
}

// Boundaries that do nothing to light but change the medium.
bool SubpathTracer::passes(const SurfaceHit& hit) const {
    return inside_ && (scene_.view.surfaces.info(hit.surface).material == MaterialKind::None ||
                       inside_->at(hit).is_false);
}

void SubpathTracer::cross(const SurfaceHit& hit) {
    if (!inside_) return;
    inside_->cross(hit);
    take_media();
}

void SubpathTracer::enter(const std::optional<InteriorStack>& inside) {
    if (!inside) return;
    inside_ = inside;
    take_media();
}

void SubpathTracer::take_media() {
    if (inside_->surface() < 0) {
        tracker_.media = scene_.path.media_in(0);
        return;
    }
    interior_ = inside_->medium();
    tracker_.media = {&interior_, interior_ ? std::size_t{1} : 0};
}

double SubpathTracer::relative_ior(const SurfaceHit& hit) const {
    if (inside_) return inside_->at(hit).relative_ior;
    const double ior = scene_.view.surfaces.info(hit.surface).ior;
    return hit.front ? ior : 1 / ior;
}

// By the means of bricks: cheap, and the same from both ends.
double SubpathTracer::expected_transmittance(const Ray& ray) {
    if (scene_.params.weights == StrategyWeights::Directions || tracker_.media.empty()) return 1;
    Vec3d depth;
    for (const Medium* m : tracker_.media) {
        if (m->strength() == 0) continue;
        const Vec3d extinction(m->cross_sections().extinction());
        double sum = 0;
        if (m->cell_size() > 0) {
            SegmentWalk walk = m->segments(ray, BrickGrain::Bricks);
            MediumSegment s;
            while (walk.next(s)) {
                sum += static_cast<double>(s.mean / m->strength()) * (s.t1 - s.t0);
            }
        } else {
            sum = exact_density_integral(*m, ray, tracker_.lookups);
        }
        depth += std::min(sum, 1e6) * extinction;
    }
    constexpr double least = 1e-6;  // below, nothing is known
    return std::max(least, (std::exp(-depth.x) + std::exp(-depth.y) + std::exp(-depth.z)) / 3);
}

}  // namespace gischt
