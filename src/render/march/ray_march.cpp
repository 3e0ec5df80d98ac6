// SPDX-License-Identifier: Apache-2.0
#include "render/march/ray_march.h"

#include <algorithm>
#include <cmath>

#include "image/color.h"
#include "math/fast_math.h"
#include "render/march/step.h"
#include "render/progressive.h"

namespace gischt {
namespace {

// Dimensions of a sample.
enum : std::uint32_t {
    DimensionJitter = SampleDimension::Free,
    DimensionSun,
    DimensionSky,
    DimensionSkyToo,
    DimensionDeep,
    DimensionStep = 16
};

using gischt::fast_exp;
Vec3f fast_exp(const Vec3f& x) {
    return {fast_exp(x.x), fast_exp(x.y), fast_exp(x.z)};
}

// Point i of a lattice that covers the square evenly for any number of points (Roberts 2018, R2),
// shifted by a random first one.
Vec2f shifted(Vec2f first, int i) {
    const float x = first.x + 0.7548777f * static_cast<float>(i),
                y = first.y + 0.5698403f * static_cast<float>(i);
    return {x - std::floor(x), y - std::floor(y)};
}

// Sum over the octaves of weight times transmittance. Where the extinction halves from octave to
// octave the transmittances are squares of each other.
float sum_of_octaves(const MarchMedium& m, std::span<const float> weights, float depth) {
    float sum = 0;
    if (m.octaves_halve) {
        float transmittance = fast_exp(-m.octaves.back().attenuation * depth);
        for (std::size_t o = weights.size(); o-- > 0; transmittance *= transmittance) {
            sum += weights[o] * transmittance;
        }
        return sum;
    }
    for (std::size_t o = 0; o < weights.size(); ++o) {
        sum += weights[o] * fast_exp(-m.octaves[o].attenuation * depth);
    }
    return sum;
}

}  // namespace

RayMarcher::RayMarcher(const MarchScene& scene)
    : scene_(scene), sky_(scene.aimed_sky), deep_(scene) {
    for (const MarchMedium& m : scene.media) {
        phase_offset_.push_back(phase_stride_);
        phase_stride_ += m.octaves.size();
    }
    phase_weight_.resize(phase_stride_ * scene.narrow.size());
    sun_.resize(scene.narrow.size());
}

// The phase functions towards lights at infinity are the same all along the ray, and one point of
// the sun's disc stands for it.
void RayMarcher::prepare_lights(const Ray& ray, const PixelSampler& sampler) {
    const Vec3d forward = normalize(ray.direction);
    for (std::size_t l = 0; l < scene_.narrow.size(); ++l) {
        if (!scene_.narrow[l].is_infinite) continue;
        sun_[l] = scene_.narrow[l].light->sample(ray.origin, sampler.two(DimensionSun));
        const auto cosine = static_cast<float>(dot(scene_.narrow[l].direction, forward));
        std::size_t at = l * phase_stride_;
        for (const MarchMedium& m : scene_.media) {
            for (const Octave& o : m.octaves) {
                phase_weight_[at++] = o.contribution * value(o.phase, cosine);
            }
        }
    }
}

MarchedRay RayMarcher::operator()(const Ray& camera_ray, const PixelSampler& sampler) {
    result_ = {};
    step_ = 0;
    ++rays_;
    Ray ray = camera_ray;
    const auto hit = scene_.view.surfaces.intersect(ray, 0.5f, RayKind::Camera);
    if (hit) ray.t_max = hit->t;
    prepare_lights(ray, sampler);
    if (scene_.depth > 1) {
        deep_.begin(sampler.stream(DimensionDeep));
        gathers_ = deep_.places(0);
    }

    // All media at once: between two neighbouring ends of segments the set of media is constant.
    walkers_.clear();
    for (std::size_t m = 0; m < scene_.media.size(); ++m) {
        walkers_.push_back({scene_.media[m].medium->segments(ray, BrickGrain::Bricks), {}, m});
        walkers_.back().advance();
    }
    double t = ray.t_min;
    const auto cutoff = static_cast<float>(scene_.params.cutoff);
    while (max_component(result_.transmittance) > cutoff) {
        double t0 = ray.t_max, t1 = ray.t_max;
        for (const Walker& w : walkers_) t0 = std::min(t0, std::max(t, w.segment.t0));
        if (!(t0 < ray.t_max)) break;
        for (Walker& w : walkers_) {
            w.is_active = w.segment.t0 <= t0;
            t1 = std::min(t1, w.is_active ? w.segment.t1 : w.segment.t0);
        }
        if (t0 < t1) march_interval(ray, t0, t1, sampler);
        t = t1;
        for (Walker& w : walkers_) {
            if (w.segment.t1 <= t) w.advance();
        }
    }

    if (max_component(result_.transmittance) <= cutoff) {
        result_.transmittance = {};
    } else if (hit) {
        const float seen = luminance(result_.transmittance);
        result_.radiance += result_.transmittance * shade(*hit, sampler);
        result_.depth += seen * static_cast<float>(hit->t);
        result_.opacity += seen;
        result_.transmittance = {};
    }
    return result_;
}

// Equal steps, jittered together: short enough for the voxels and for the optical depth.
void RayMarcher::march_interval(const Ray& ray, double t0, double t1, const PixelSampler& sampler) {
    const double metres = (t1 - t0) * length(ray.direction);
    double steps = 1, majorant = 0;
    bool is_visible = false, is_plain = true;
    for (const Walker& w : walkers_) {
        if (!w.is_active) continue;
        const MarchMedium& m = scene_.media[w.medium];
        steps = std::max(steps, metres / (scene_.params.step * m.feature));
        majorant += static_cast<double>(w.segment.max);
        is_visible = is_visible || w.segment.max > 0 || m.medium->is_emissive();
        is_plain = is_plain && w.segment.min == w.segment.max && !m.medium->is_emissive() &&
                   max_component(m.scattering) == 0;
    }
    if (!is_visible) return;
    steps = std::max(steps, metres * majorant / scene_.params.step_depth);
    if (is_plain) steps = 1;  // constant absorption and nothing else: one step is exact
    const int n = static_cast<int>(std::ceil(std::min(steps, 1e5)));
    const double dt = (t1 - t0) / n;
    const auto cutoff = static_cast<float>(scene_.params.cutoff);
    const float jitter = sampler.two(DimensionJitter).x;
    std::array<double, batch> t;
    for (int first = 0; first < n; first += static_cast<int>(batch)) {
        const std::size_t count = std::min(batch, static_cast<std::size_t>(n - first));
        for (std::size_t i = 0; i < count; ++i) {
            t[i] = t0 + (first + static_cast<double>(i)) * dt;
        }
        march_batch(ray, {t.data(), count}, dt, jitter, sampler);
        if (max_component(result_.transmittance) <= cutoff) return;
    }
}

// Up to 16 steps that begin at t: eq. 19.
void RayMarcher::march_batch(const Ray& ray, std::span<const double> t, double dt, float jitter,
                             const PixelSampler& sampler) {
    const auto length = static_cast<float>(dt * gischt::length(ray.direction));
    std::array<float, batch> local;
    for (Walker& w : walkers_) {
        if (!w.is_active) continue;
        const Medium& medium = *scene_.media[w.medium].medium;
        for (std::size_t i = 0; i < t.size(); ++i) {
            local[i] =
                static_cast<float>(t[i] + static_cast<double>(jitter) * dt - w.segment.anchor);
        }
        medium.densities(w.segment, {local.data(), t.size()}, w.density.data());
        lookups_ += static_cast<std::int64_t>(t.size());
        if (medium.has_color()) {
            for (std::size_t i = 0; i < t.size(); ++i) {
                w.scattering[i] = scene_.media[w.medium].scattering *
                                  medium.color_at(w.segment, local[i], w.density[i]);
            }
        }
        if (medium.is_emissive()) {
            medium.emissions(w.segment, {local.data(), t.size()}, w.density.data(),
                             w.emission.data());
        }
    }
    for (std::size_t i = 0; i < t.size(); ++i, ++step_) {
        Vec3f extinction, glow;
        for (const Walker& w : walkers_) {
            if (!w.is_active) continue;
            const MarchMedium& m = scene_.media[w.medium];
            if (m.medium->is_emissive()) glow += w.emission[i];
            extinction += w.density[i] * m.extinction;
        }
        if (extinction == Vec3f{} && glow == Vec3f{}) continue;
        const Vec3f transmittance = scene_.is_grey ? Vec3f(fast_exp(-length * extinction.x))
                                                   : fast_exp(-length * extinction);
        const Vec3f gain = result_.transmittance * source_length(extinction, transmittance, length);
        result_.radiance += gain * glow;
        scatter(ray, ray.at(t[i] + lit_place(jitter, extinction, length) / length * dt), i, gain,
                sampler);
        const float lost = luminance(result_.transmittance * (Vec3f(1) - transmittance));
        result_.depth += lost * static_cast<float>(t[i] + static_cast<double>(jitter) * dt);
        result_.opacity += lost;
        result_.transmittance = result_.transmittance * transmittance;
        if (max_component(result_.transmittance) <= static_cast<float>(scene_.params.cutoff)) {
            return;
        }
    }
}

// What step i of a batch scatters of the light that arrives at a point in it.
void RayMarcher::scatter(const Ray& ray, const Vec3d& point, std::size_t i, const Vec3f& gain,
                         const PixelSampler& sampler) {
    for (const Walker& w : walkers_) {
        if (!w.is_active || w.density[i] == 0) continue;
        const MarchMedium& m = scene_.media[w.medium];
        const Vec3f weight =
            gain * w.density[i] * (m.medium->has_color() ? w.scattering[i] : m.scattering);
        if (!(max_component(weight) > 0)) continue;
        Vec3f arrives = in_scattered(w.medium, ray, point, sampler);
        if (scene_.depth > 1) {
            const float gathered = gathers_.weight_of(luminance(weight));
            if (gathered > 0) {
                arrives += gathered * deep_.at_medium(w.medium, point, normalize(ray.direction), 0);
            }
        }
        result_.radiance += weight * arrives;
    }
}

// Sum over the lights of radiance times phase function, per scattering coefficient.
Vec3f RayMarcher::in_scattered(std::size_t medium, const Ray& ray, const Vec3d& point,
                               const PixelSampler& sampler) {
    Vec3f sum = from_broad(medium, ray, point, sampler);
    for (std::size_t l = 0; l < scene_.narrow.size(); ++l) {
        sum += from_narrow(medium, l, ray, point);
    }
    return sum;
}

Vec3f RayMarcher::from_narrow(std::size_t medium, std::size_t light, const Ray& ray,
                              const Vec3d& point) {
    const NarrowLight& narrow = scene_.narrow[light];
    LightSample s;
    s.direction = narrow.direction;
    s.weight = narrow.weight;
    if (!narrow.is_infinite) s = narrow.light->sample(point, {0, 0});
    if (max_component(s.weight) <= 0) return {};
    // Surfaces cast the soft shadow of the sun's disc.
    if (!scene_.view.surfaces.is_empty()) {
        const Vec3d& towards = narrow.is_infinite ? sun_[light].direction : s.direction;
        if (scene_.view.surfaces.is_blocked({point, towards, 0, s.distance})) return {};
    }
    const Vec3f depth = scene_.depth_to(light, point, s, medium);
    const MarchMedium& m = scene_.media[medium];
    const float* weight = phase_weight_.data() + light * phase_stride_ + phase_offset_[medium];
    if (!narrow.is_infinite) {
        const auto cosine = static_cast<float>(dot(s.direction, normalize(ray.direction)));
        local_weight_.clear();
        for (const Octave& o : m.octaves) {
            local_weight_.push_back(o.contribution * value(o.phase, cosine));
        }
        weight = local_weight_.data();
    }
    const std::span<const float> weights(weight, m.octaves.size());
    if (scene_.is_grey) return s.weight * sum_of_octaves(m, weights, depth.x);
    return s.weight * Vec3f(sum_of_octaves(m, weights, depth.x),
                            sum_of_octaves(m, weights, depth.y),
                            sum_of_octaves(m, weights, depth.z));
}

// Directions drawn from the light and from the phase function, weighed by the balance heuristic
// (Veach & Guibas 1995).
Vec3f RayMarcher::from_broad(std::size_t medium, const Ray& ray, const Vec3d& point,
                             const PixelSampler& sampler) {
    const MarchMedium& m = scene_.media[medium];
    if (m.sky) return (*m.sky)(point);
    const Vec3d forward = normalize(ray.direction);
    const int n = scene_.params.sky_samples;
    const Vec2f first = sampler.two(DimensionStep + step_);
    Vec3f sum;
    for (const Light* light : scene_.broad) {
        for (int i = 0; i < 2 * n; ++i) {
            const bool from_light = i % 2 == 1;
            const Vec2f u = shifted(first, i / 2);
            Vec3d towards;
            float light_pdf, phase_pdf;
            if (from_light) {
                const LightSample s = light->sample(point, u);
                towards = s.direction;
                light_pdf = s.pdf;
                phase_pdf = value(m.octaves[0].phase, static_cast<float>(dot(towards, forward)));
            } else {
                const PhaseSample s = sample(m.octaves[0].phase, Vec3f(forward), u);
                towards = normalize(Vec3d(s.direction));
                phase_pdf = s.pdf;
                light_pdf = light->pdf(point, towards);
            }
            const Vec3f radiance = light->radiance(towards);
            const Ray shadow{point, towards};
            if (max_component(radiance) <= 0 || scene_.view.surfaces.is_blocked(shadow)) continue;
            ++rays_;
            const Vec3f depth =
                optical_depth(scene_.view.media, shadow, scene_.shadow_steps(), &lookups_);
            Vec3f scattered;
            const auto cosine = static_cast<float>(dot(towards, forward));
            for (const Octave& o : m.octaves) {
                scattered +=
                    o.contribution * value(o.phase, cosine) * fast_exp(-o.attenuation * depth);
            }
            sum += radiance * scattered * (1 / (static_cast<float>(n) * (light_pdf + phase_pdf)));
        }
    }
    return sum;
}

// Transmittance of a shadow ray. That of the sky is taken in longer steps: it is one of many.
Vec3f RayMarcher::through_media(const Ray& ray, double step) {
    ++rays_;
    return fast_exp(-optical_depth(scene_.view.media, ray, {step, 10}, &lookups_));
}

// Lambert reflection of all lights, each seen through the media.
Vec3f RayMarcher::shade(const SurfaceHit& hit, const PixelSampler& sampler) {
    Vec3f irradiance;
    for (std::size_t l = 0; l < scene_.narrow.size(); ++l) {
        const NarrowLight& narrow = scene_.narrow[l];
        const LightSample s =
            narrow.is_infinite ? sun_[l] : narrow.light->sample(hit.point, {0, 0});
        const double cosine = dot(s.direction, hit.normal);
        if (cosine <= 0 || max_component(s.weight) <= 0) continue;
        Ray shadow = leaving_ray(hit, s.direction);
        shadow.t_max = s.distance;
        if (scene_.view.surfaces.is_blocked(shadow)) continue;
        irradiance += static_cast<float>(cosine) * s.weight *
                      through_media(shadow, scene_.params.shadow_step);
    }
    for (std::size_t b = 0; b < scene_.broad.size(); ++b) {
        irradiance += sky_irradiance(b, hit, sampler);
    }
    if (scene_.depth > 1) irradiance += deep_.at_surface(hit, 0);
    return hit.emission + static_cast<float>(1 / pi) * hit.albedo * irradiance;
}

// Directions in proportion to radiance times cosine. The light of an open sky is known: it takes
// the place of what the same directions say of it (a control variate), as far as it arrives at all,
// so that there is no noise where all or nothing of the sky is seen. How much arrives is estimated
// by two sets of directions; each takes the other's estimate, so that the sum stays unbiased.
Vec3f RayMarcher::sky_irradiance(std::size_t broad, const SurfaceHit& hit,
                                 const PixelSampler& sampler) {
    sky_[broad].aim(hit.normal);
    const SkyEstimate sets[2] = {estimate_sky(broad, hit, sampler.two(DimensionSky)),
                                 estimate_sky(broad, hit, sampler.two(DimensionSkyToo))};
    const Vec3f open = scene_.open_sky[broad](hit.normal);
    Vec3f sum;
    for (std::size_t i = 0; i < 2; ++i) {
        const SkyEstimate &one = sets[i], &other = sets[1 - i];
        const float all = luminance(other.open);
        const float share = all > 0 ? luminance(other.arriving) / all : 0.0f;
        sum += 0.5f * (one.arriving + share * (open - one.open));
    }
    return sum;
}

RayMarcher::SkyEstimate RayMarcher::estimate_sky(std::size_t broad, const SurfaceHit& hit,
                                                 Vec2f first) {
    const int n = scene_.params.sky_samples;
    SkyEstimate sum;
    for (int i = 0; i < n; ++i) {
        const AimedSky::Direction d = sky_[broad](shifted(first, i));
        if (max_component(d.weight) <= 0) continue;
        sum.open += d.weight / static_cast<float>(n);
        const Ray shadow = leaving_ray(hit, d.towards);
        if (scene_.view.surfaces.is_blocked(shadow)) continue;
        sum.arriving +=
            d.weight * through_media(shadow, 2 * scene_.params.shadow_step) / static_cast<float>(n);
    }
    return sum;
}

}  // namespace gischt
