// SPDX-License-Identifier: Apache-2.0
#include "render/march/deep_march.h"

#include <algorithm>
#include <array>

#include "base/units.h"
#include "image/color.h"
#include "math/fast_math.h"
#include "optics/environment.h"
#include "render/march/step.h"
#include "render/path/media_walk.h"

namespace gischt {
namespace {

constexpr float least_seen = 1e-3f;  // transmittance at which a deep ray ends

Vec3f transmittance_of(const Vec3f& depth) {
    return {fast_exp(-depth.x), fast_exp(-depth.y), fast_exp(-depth.z)};
}

// Point i of a lattice that covers the square evenly for any number of points (Roberts 2018, R2),
// shifted by a random first one.
Vec2f lattice_point(Vec2f first, int i) {
    const float x = first.x + 0.7548777f * static_cast<float>(i),
                y = first.y + 0.5698403f * static_cast<float>(i);
    return {x - std::floor(x), y - std::floor(y)};
}

// In proportion to the cosine with the normal.
Vec3d cosine_direction(const Vec3d& normal, Vec2f u) {
    Vec3d s, t;
    orthonormal_frame(normal, s, t);
    const double r2 = static_cast<double>(u.x), phi = 2 * pi * static_cast<double>(u.y);
    const double r = std::sqrt(r2);
    return normalize(r * std::cos(phi) * s + r * std::sin(phi) * t + std::sqrt(1 - r2) * normal);
}

}  // namespace

DeepMarch::DeepMarch(const MarchScene& scene) : scene_(scene) {
    for (const MarchMedium& m : scene.media) {
        media_.push_back(m.medium);
        has_glow_ = has_glow_ || m.medium->is_emissive();
    }
    for (int i = 0; i < scene.view.surfaces.size(); ++i) {
        has_glow_ = has_glow_ || max_component(scene.view.surfaces.info(i).emission) > 0;
    }
    for (const Light* light : scene.broad) {
        if (!dynamic_cast<const ConstantLight*>(light)) drawn_.push_back(light);
    }
}

GatherPlaces DeepMarch::places(int level) {
    const double most = scene_.params.gathers;
    // At least one for all of the light: rarer ones would weigh more than 1 each, and sparkle.
    const double gathers =
        std::max(std::min(most, 1.0), most * std::pow(scene_.params.thinning, level));
    return {gathers, numbers_.next()};
}

int DeepMarch::directions(int level) const {
    const double n = scene_.params.directions * std::pow(scene_.params.thinning, level);
    return std::max(1, static_cast<int>(std::lround(n)));
}

Vec3f DeepMarch::at_medium(std::size_t medium, const Vec3d& point, const Vec3d& forward,
                           int level) {
    const int deeper = level + 1, n = directions(level);
    if (!carries(deeper)) return {};
    const PhaseFunction& phase = scene_.media[medium].medium->phase();
    const Vec2f first = numbers_.next_two();
    Vec3f sum;
    for (int i = 0; i < n; ++i) {
        const PhaseSample s = sample(phase, Vec3f(forward), lattice_point(first, i));
        sum +=
            follow({point, normalize(Vec3d(s.direction))}, deeper, static_cast<float>(n) * s.pdf);
    }
    if (!sees_sky(deeper)) return sum / static_cast<float>(n);
    for (const Light* light : drawn_) {
        const LightSample s = light->sample(point, numbers_.next_two());
        const Ray ray{point, s.direction};
        if (!(s.pdf > 0) || scene_.view.surfaces.is_blocked(ray)) continue;
        ++rays;
        const float pdf = value(phase, static_cast<float>(dot(forward, s.direction)));
        const float counted = s.pdf / (s.pdf + static_cast<float>(n) * pdf);
        sum +=
            static_cast<float>(n) * counted * pdf * s.weight *
            transmittance_of(optical_depth(scene_.view.media, ray, scene_.deep_steps(), &lookups));
    }
    return sum / static_cast<float>(n);
}

Vec3f DeepMarch::at_surface(const SurfaceHit& hit, int level) {
    const int deeper = level + 1, n = directions(level);
    if (!carries(deeper)) return {};
    const Vec2f first = numbers_.next_two();
    Vec3f sum;
    for (int i = 0; i < n; ++i) {
        const Vec3d towards = cosine_direction(hit.normal, lattice_point(first, i));
        const auto cosine = static_cast<float>(dot(towards, hit.normal));
        sum += follow(leaving_ray(hit, towards), deeper,
                      static_cast<float>(n) * cosine / static_cast<float>(pi));
    }
    sum *= static_cast<float>(pi) / static_cast<float>(n);
    if (!sees_sky(deeper)) return sum;
    for (const Light* light : drawn_) {
        const LightSample s = light->sample(hit.point, numbers_.next_two());
        const auto cosine = static_cast<float>(dot(s.direction, hit.normal));
        const Ray ray = leaving_ray(hit, s.direction);
        if (!(s.pdf > 0) || cosine <= 0 || scene_.view.surfaces.is_blocked(ray)) continue;
        ++rays;
        const float other = static_cast<float>(n) * cosine / static_cast<float>(pi);
        sum +=
            s.pdf / (s.pdf + other) * cosine * s.weight *
            transmittance_of(optical_depth(scene_.view.media, ray, scene_.deep_steps(), &lookups));
    }
    return sum;
}

// What arrives along a ray, `pdf` being the density of all directions drawn with it, 1/sr.
Vec3f DeepMarch::follow(Ray ray, int level, float pdf) {
    ++rays;
    const auto hit = scene_.view.surfaces.intersect(ray);
    if (hit) ray.t_max = hit->t;
    Vec3f transmittance(1), radiance;
    if (scatters(level) || has_glow_) {
        radiance = march(ray, level, transmittance);
    } else {
        transmittance =
            transmittance_of(optical_depth(scene_.view.media, ray, scene_.deep_steps(), &lookups));
    }
    if (max_component(transmittance) < least_seen) return radiance;
    if (hit) return radiance + transmittance * shade(*hit, level);
    return sees_sky(level) ? radiance + transmittance * behind(ray.direction, pdf) : radiance;
}

// Eq. 19 front to back.
Vec3f DeepMarch::march(const Ray& ray, int level, Vec3f& transmittance) {
    const bool is_lit = scatters(level);
    const double longer = scene_.params.deep_step;
    GatherPlaces gathers = places(level);
    const float jitter = numbers_.next();
    MediaWalk walk(media_, ray, BrickGrain::Bricks);
    MediaRun run;
    Vec3f radiance;
    std::array<Vec3f, most_media> scattering;
    while (walk.next(run)) {
        if (!(run.max > 0) && !(run.emission_max > 0)) continue;
        const double metres = run.t1 - run.t0;
        double steps = metres * static_cast<double>(run.max) / (longer * scene_.params.step_depth);
        for (const ActiveMedium& a : run.active) {
            steps = std::max(
                steps, metres / (longer * scene_.params.step * scene_.media[a.index].feature));
        }
        const int n = static_cast<int>(std::ceil(std::clamp(steps, 1.0, 1e5)));
        const auto length = static_cast<float>(metres / n);
        for (int i = 0; i < n; ++i) {
            const double t = run.t0 + (i + static_cast<double>(jitter)) * metres / n;
            Vec3f extinction, glow;
            for (std::size_t k = 0; k < run.active.size(); ++k) {
                const ActiveMedium& a = run.active[k];
                const MarchMedium& m = scene_.media[a.index];
                const auto local = static_cast<float>(t - a.segment.anchor);
                const float density = m.medium->density_at(a.segment, local);
                ++lookups;
                extinction += density * m.extinction;
                scattering[k] =
                    density * m.scattering * m.medium->color_at(a.segment, local, density);
                glow += m.medium->emission_at(a.segment, local, density);
            }
            const Vec3f passes = transmittance_of(length * extinction);
            const Vec3f gain = transmittance * source_length(extinction, passes, length);
            radiance += gain * glow;
            const Vec3d point =
                ray.at(run.t0 + i * metres / n + lit_place(jitter, extinction, length));
            for (std::size_t k = 0; is_lit && k < run.active.size(); ++k) {
                const Vec3f weight = gain * scattering[k];
                if (!(max_component(weight) > 0)) continue;
                const std::size_t medium = run.active[k].index;
                Vec3f arrives = from_lights(medium, point, ray.direction);
                const float gathered = gathers.weight_of(luminance(weight));
                if (gathered > 0) {
                    arrives += gathered * at_medium(medium, point, ray.direction, level);
                }
                radiance += weight * arrives;
            }
            transmittance = transmittance * passes;
            if (max_component(transmittance) < least_seen) return radiance;
        }
    }
    return radiance;
}

// What suns and points send straight to a point, times the phase function.
Vec3f DeepMarch::from_lights(std::size_t medium, const Vec3d& point, const Vec3d& forward) {
    Vec3f sum;
    for (std::size_t l = 0; l < scene_.narrow.size(); ++l) {
        const NarrowLight& narrow = scene_.narrow[l];
        LightSample s = narrow.light->sample(point, numbers_.next_two());
        const Ray shadow{point, s.direction, 0, s.distance};
        if (max_component(s.weight) <= 0 || scene_.view.surfaces.is_blocked(shadow)) continue;
        if (narrow.is_infinite) s.direction = narrow.direction;
        const auto cosine = static_cast<float>(dot(s.direction, forward));
        sum += value(scene_.media[medium].medium->phase(), cosine) * s.weight *
               transmittance_of(scene_.depth_to(l, point, s, medium));
    }
    return sum;
}

// Lambert reflection of all that arrives.
Vec3f DeepMarch::shade(const SurfaceHit& hit, int level) {
    if (!scatters(level)) return hit.emission;
    Vec3f irradiance = at_surface(hit, level);
    for (const NarrowLight& narrow : scene_.narrow) {
        const LightSample s = narrow.light->sample(hit.point, numbers_.next_two());
        const auto cosine = static_cast<float>(dot(s.direction, hit.normal));
        Ray shadow = leaving_ray(hit, s.direction);
        shadow.t_max = s.distance;
        if (cosine <= 0 || scene_.view.surfaces.is_blocked(shadow)) continue;
        ++rays;
        irradiance += cosine * s.weight *
                      transmittance_of(
                          optical_depth(scene_.view.media, shadow, scene_.deep_steps(), &lookups));
    }
    return hit.emission + static_cast<float>(1 / pi) * hit.albedo * irradiance;
}

// The sky that a ray sees, weighed against directions drawn from it.
Vec3f DeepMarch::behind(const Vec3d& direction, float pdf) const {
    Vec3f sum;
    for (const Light* light : scene_.broad) {
        const bool is_drawn = std::find(drawn_.begin(), drawn_.end(), light) != drawn_.end();
        const float other = is_drawn ? light->pdf({}, direction) : 0;
        sum += pdf / (pdf + other) * light->radiance(direction);
    }
    return sum;
}

}  // namespace gischt
