// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/bdpt_tracer.h"

#include <algorithm>
#include <cmath>

#include "image/color.h"
#include "render/progressive.h"

namespace gischt {
namespace {

// Dimensions of a sample; from there on the streams.
enum : std::uint32_t {
    DimensionHero = SampleDimension::Free,
    DimensionTurn,         // the first turns and flights of the camera's path,
    DimensionChoice = 10,  // RandomStream::last_leading
    DimensionPlace,
    DimensionDirection,
    DimensionExtra,
    DimensionStream = 1000
};
static_assert(DimensionChoice == RandomStream::last_leading);

LightNumbers light_numbers(const PixelSampler& sampler) {
    return {sampler.one(DimensionChoice), sampler.one(DimensionExtra), sampler.two(DimensionPlace),
            sampler.two(DimensionDirection)};
}

// Ends a little before a surface that is to be reached.
constexpr double shortening = 1e-9;

}  // namespace

BdptTracer::BdptTracer(const BdptScene& scene, int depth, double margin)
    : scene_(scene), depth_(depth), margin_(margin), tracer_(scene, depth) {}

BdptTracer::Seen BdptTracer::operator()(const Ray& ray, Vec2f lens, const PixelSampler& sampler) {
    Seen seen;
    splats_.clear();
    brightest_ = 0;
    has_roulette_ = true;
    const int hero =
        scene_.path.is_grey ? 0 : std::min(static_cast<int>(3 * sampler.one(DimensionHero)), 2);
    RandomStream eye{sampler.stream_key(DimensionStream), 0, sampler, DimensionTurn};
    trace_camera(ray, hero, eye, {});
    RandomStream far{sampler.stream_key(DimensionStream + 1)};
    trace_light(light_numbers(sampler), hero, far, {});
    RandomStream random{sampler.stream_key(DimensionStream + 2)};
    for (std::size_t i = 1; i < camera_.vertices.size(); ++i) {
        seen.radiance += found_surface(i);
    }
    for (const Subpath::Glow& g : camera_.glows) seen.radiance += found_glow(g);
    seen.radiance += escaped(&seen.alpha);
    for (std::size_t t = 2; t <= camera_.vertices.size(); ++t) {
        seen.radiance += sampled(t, random);
        for (std::size_t s = 2; s <= light_.vertices.size(); ++s) {
            seen.radiance += connected(s, t, random);
        }
    }
    for (std::size_t s = 2; s <= light_.vertices.size(); ++s) {
        const FilmSplat splat = splatted(s, lens, random);
        if (max_component(splat.value) > 0) splats_.push_back(splat);
    }
    if (camera_.vertices.size() > 1) seen.depth = length(camera_.vertices[1].point - ray.origin);
    return seen;
}

BdptTracer::Seen BdptTracer::near(const Ray& ray, bool direct, const PixelSampler& sampler) {
    Seen seen;
    brightest_ = 0;
    has_roulette_ = has_light_paths_ = false;
    const int hero =
        scene_.path.is_grey ? 0 : std::min(static_cast<int>(3 * sampler.one(DimensionHero)), 2);
    RandomStream eye{sampler.stream_key(DimensionStream), 0, sampler, DimensionTurn};
    trace_camera(ray, hero, eye, {});
    RandomStream random{sampler.stream_key(DimensionStream + 2)};
    const auto& path = camera_.vertices;
    for (std::size_t t = 2; t <= path.size() + 1; ++t) {
        const PathVertex& last = path[t - 2];
        const bool is_seen = last.events == 0 && (t == 2 || last.is_delta);
        if (is_seen || (direct && t == 3)) seen.radiance += found(t, &seen.alpha);
    }
    if (direct && path.size() > 1) seen.radiance += sampled(2, random);
    if (path.size() > 1) seen.depth = length(path[1].point - ray.origin);
    return seen;
}

void BdptTracer::trace_camera(const Ray& ray, int hero, RandomStream& random,
                              const SubpathTracer::Length& length) {
    // The density of film area per solid angle, or per area across the ray.
    const bool is_parallel = scene_.view.camera.projection() == Projection::Orthographic;
    const double cosine = dot(ray.direction, scene_.view.camera.forward());
    const double edge = scene_.view.camera.pixel_size(1);
    const double squeeze = is_parallel ? cosine : cosine * cosine * cosine;
    const double density = 1 / (edge * edge * squeeze * film_pixels());
    tracer_.from_camera(ray, density, hero, random, length, camera_);
}

// ---- s = 0: the camera's path meets a light.

Vec3f BdptTracer::found(std::size_t count, float* alpha) {
    Vec3f sum;
    const std::size_t last = count - 1;
    if (last < camera_.vertices.size()) sum += found_surface(last);
    for (const Subpath::Glow& g : camera_.glows) {
        if (g.from + 1 == last) sum += found_glow(g);
    }
    if (camera_.vertices.size() == last) sum += escaped(alpha);
    return sum;
}

Vec3f BdptTracer::found_surface(std::size_t i) {
    const PathVertex &v = camera_.vertices[i], &u = camera_.vertices[i - 1];
    if (!v.hit || !(max_component(v.hit->emission) > 0)) return {};
    const Vec3f radiance = v.weight.value() * v.hit->emission;
    const LightEnd end = surface_end(scene_, *v.hit, u.point);
    const auto all = strategies(end, i, u.onward, v.through, u.return_, false);
    return radiance * static_cast<float>(
                          share({0, i + 1, 0, v.through, &end, radiance}, all.found, all.sum()));
}

Vec3f BdptTracer::found_glow(const Subpath::Glow& glow) {
    const PathVertex& u = camera_.vertices[glow.from];
    const LightEnd end = glow_end(scene_, *glow.medium, glow.point, u.point);
    if (!(end.distance > 0)) return glow.radiance;
    const auto all = strategies(end, glow.from + 1, u.onward, glow.through, u.return_, false);
    return glow.radiance *
           static_cast<float>(share({0, glow.from + 2, 0, glow.through, &end, glow.radiance},
                                    all.found, all.sum()));
}

// The camera sees the background, others the lights themselves.
Vec3f BdptTracer::escaped(float* alpha) {
    if (!camera_.escape) return {};
    const Subpath::Escape& out = *camera_.escape;
    const Vec3f weight = out.weight.value();
    const std::size_t t = camera_.vertices.size() + 1;
    if (t == 2) {
        const BackgroundSample behind = background(scene_.view, out.direction);
        if (alpha) *alpha -= (weight.x + weight.y + weight.z) / 3 * (1 - behind.alpha);
        if (only && *only != std::pair<std::size_t, std::size_t>{0, 2}) return {};
        return weight * behind.radiance;
    }
    const PathVertex& u = camera_.vertices.back();
    Vec3f sum;
    for (const LightPtr& light : scene_.view.lights) {
        if (!light->is_infinite() || light->is_delta()) continue;
        const Vec3f radiance = weight * light->radiance(out.direction);
        if (!(max_component(radiance) > 0)) continue;
        const LightEnd end = far_end(scene_, *light, u.point, out.direction);
        const auto all =
            strategies(end, camera_.vertices.size(), u.onward, out.through, u.return_, false);
        sum += radiance * static_cast<float>(
                              share({0, t, 0, out.through, &end, radiance}, all.found, all.sum()));
    }
    return sum;
}

// ---- s = 1: a light sampled for a vertex.

Vec3f BdptTracer::sampled(std::size_t t, RandomStream& random) {
    const PathVertex& v = camera_.vertices[t - 1];
    if (!v.can_connect() || v.events >= depth_) return {};
    Vec3f sum;
    for (const SunSource& sun : scene_.path.suns) {
        const DrawnLight drawn{sun.light, nullptr, sun.light->sample(v.point, random.two()), 1};
        sum += from_light(v, t, drawn, random);
    }
    if (!scene_.path.local.empty()) {
        sum += from_light(v, t, draw_local(scene_, v.point, random), random);
    }
    if (!scene_.path.broad.empty()) {
        sum += from_light(v, t, draw_broad(scene_, v.point, random), random);
    }
    if (!scene_.glow.is_empty()) {
        sum += from_light(v, t, draw_glow(scene_, v.point, random), random);
    }
    return sum;
}

Vec3f BdptTracer::from_light(const PathVertex& v, std::size_t t, const DrawnLight& drawn,
                             RandomStream& random) {
    if (!drawn.light && !drawn.medium) return {};
    const LightSample& s = drawn.sample;
    if (!(max_component(s.weight) > 0)) return {};
    Vec3f radiance = v.weight.value() * scattering(surfaces(), v, v.back, s.direction) * s.weight *
                     (1 / drawn.share);
    if (!(max_component(radiance) > 0)) return {};

    // What is in between, and where on a surface the light is.
    const auto* surface = dynamic_cast<const SurfaceLight*>(drawn.light);
    Ray ray = SubpathTracer::leave(v, s.direction);
    ray.t_max = drawn.medium ? s.distance * (1 - shortening) : s.distance;
    const auto way = tracer_.passage(v, ray, RayKind::Other, surface ? surface->surface() : -1);
    if (!way.is_open) return {};

    LightEnd end;
    if (surface) {
        end = surface_end(scene_, *way.reached, v.point);
    } else if (drawn.medium) {
        end = glow_end(scene_, *drawn.medium, v.point + s.distance * s.direction, v.point);
    } else if (drawn.light->is_infinite()) {
        end = far_end(scene_, *drawn.light, v.point, s.direction);
    } else {
        end = point_end(scene_, *drawn.light, v.point + s.distance * s.direction, v.point);
    }
    const double found = direction_density(surfaces(), v, v.back, s.direction),
                 back = direction_density(surfaces(), v, s.direction, v.back);
    const auto all = strategies(end, t, found, way.through, back, true);
    const double part = share({1, t, 0, way.through, &end, radiance}, all.sampled, all.sum());
    radiance *= static_cast<float>(part);
    if (!is_spared(radiance, random)) return {};
    return radiance * tracer_.transmittance(v, ray, way, random);
}

// ---- s >= 2, t >= 2: connections.

Vec3f BdptTracer::connected(std::size_t s, std::size_t t, RandomStream& random) {
    const PathVertex &z = camera_.vertices[t - 1], &y = light_.vertices[s - 1];
    if (!z.can_connect() || !y.can_connect() || z.events + y.events + 2 > depth_) return {};
    const Vec3d between = y.point - z.point;
    const double d2 = dot(between, between);
    if (!(d2 > 0)) return {};
    const Vec3d way = between / std::sqrt(d2);
    const Vec3f values =
        scattering(surfaces(), z, z.back, way) * adjoint_scattering(surfaces(), y, -way, y.back);
    if (!(max_component(values) > 0)) return {};
    PathWeight weight{z.weight.weight * y.weight.weight * values, z.weight.rate * y.weight.rate};
    Vec3f radiance = weight.value() * static_cast<float>(1 / d2);

    const Vec3d to = SubpathTracer::leave(y, -way).origin;
    Ray ray = SubpathTracer::leave(z, way);
    const double distance = length(to - ray.origin);
    if (!(distance > 0)) return {};
    ray.direction = (to - ray.origin) / distance;
    ray.t_max = distance * (1 - shortening);
    const auto passage = tracer_.passage(z, ray, RayKind::Other);
    if (!passage.is_open) return {};

    // What other connections of the same path there are, towards the camera and towards the light.
    const double by_light = density_at(z, way, direction_density(surfaces(), y, y.back, -way), d2);
    const double by_camera = density_at(y, way, direction_density(surfaces(), z, z.back, way), d2);
    const double own = power_heuristic(1 / passage.through);
    const double nearer = power_heuristic(by_light / z.density) *
                          strategies_before(scene_, camera_.first(t),
                                            direction_density(surfaces(), z, way, z.back), true);
    const double farther = power_heuristic(by_camera / y.density) *
                           strategies_before(scene_, light_.first(s),
                                             direction_density(surfaces(), y, -way, y.back), true);
    radiance *= static_cast<float>(
        share({s, t, 0, passage.through, nullptr, radiance}, own, own + nearer + farther));
    if (!is_spared(radiance, random)) return {};
    return radiance * tracer_.transmittance(z, ray, passage, random);
}

// ---- t = 1: onto the film.

FilmSplat BdptTracer::splatted(std::size_t s, Vec2f lens, RandomStream& random) {
    const PathVertex& y = light_.vertices[s - 1];
    if (!y.can_connect() || y.events >= depth_) return {};
    const auto sight = scene_.view.camera.see(y.point, lens);
    if (!sight) return {};
    const Vec2d& film = sight->film;
    if (!(film.x > -margin_ && film.y > -margin_ && film.x < scene_.view.width() + margin_ &&
          film.y < scene_.view.height() + margin_)) {
        return {};
    }
    const Vec3d to_eye = -sight->direction;
    const double d2 = sight->is_parallel ? 1 : sight->distance * sight->distance;
    const double density = sight->density / film_pixels();
    Vec3f radiance = y.weight.value() * adjoint_scattering(surfaces(), y, to_eye, y.back) *
                     static_cast<float>(density / d2);
    if (!(max_component(radiance) > 0)) return {};
    Ray ray = SubpathTracer::leave(y, to_eye);
    ray.t_max = sight->distance;
    const auto passage = tracer_.passage(y, ray, RayKind::Camera);
    if (!passage.is_open) return {};
    const double own = power_heuristic(1 / passage.through);
    const double farther =
        power_heuristic(density_at(y, to_eye, density, d2) / y.density) *
        strategies_before(scene_, light_.first(s), direction_density(surfaces(), y, to_eye, y.back),
                          true);
    radiance *= static_cast<float>(
        share({s, 1, 0, passage.through, nullptr, radiance}, own, own + farther));
    if (!is_spared(radiance, random)) return {};
    return {{static_cast<float>(film.x), static_cast<float>(film.y)},
            radiance * tracer_.transmittance(y, ray, passage, random)};
}

// ----

// Of a path whose first t vertices are the camera's.
LightEndStrategies BdptTracer::strategies(const LightEnd& light, std::size_t t, double found,
                                          double through, double back_density, bool is_end) const {
    LightEnd end = light;
    if (!has_light_paths_) end.emitted = {};
    return strategies_at(scene_, camera_.first(t), end, found, through, back_density, is_end);
}

double BdptTracer::share(const Weighed& path, double own, double all) const {
    const double part = own > 0 && std::isfinite(all) ? own / all : 0;
    if (watch) {
        Weighed seen = path;
        seen.weight = part;
        watch(seen);
    }
    if (only) return *only == std::pair(path.s, path.t) ? 1 : 0;
    return part;
}

// Russian roulette of a contribution whose transmittance is not known yet.
bool BdptTracer::is_spared(Vec3f& radiance, RandomStream& random) {
    const double bright = static_cast<double>(max_component(radiance));
    if (!(bright > 0)) return false;
    if (!has_roulette_ || only) return true;
    const double threshold = scene_.params.connection * brightest_;
    brightest_ = std::max(brightest_, bright);
    if (bright >= threshold) return true;
    if (static_cast<double>(random.next()) * threshold >= bright) return false;
    radiance *= static_cast<float>(threshold / bright);
    return true;
}

}  // namespace gischt
