// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "image/film.h"
#include "render/bdpt/light_choice.h"
#include "render/bdpt/strategy_weights.h"
#include "render/bdpt/subpath_tracer.h"

namespace gischt {

// Bidirectional path tracing of one sample: a path from the camera, one from a light, and what
// comes of all ways to join them. Keeps scratch memory; one per thread.
class BdptTracer {
  public:
    // `margin`: pixels around the picture in which splats still count.
    BdptTracer(const BdptScene& scene, int depth, double margin);

    struct Seen {
        Vec3f radiance;  // the background included
        float alpha = 1;
        double depth = -1;  // along the ray, of the first vertex; negative without one
    };
    // Also fills splats().
    Seen operator()(const Ray& ray, Vec2f lens, const PixelSampler& sampler);
    const std::vector<FilmSplat>& splats() const { return splats_; }
    // Without light paths: what the camera sees itself, also by single directions, and with
    // `direct` what the first vertex after it scatters straight from a light.
    Seen near(const Ray& ray, bool direct, const PixelSampler& sampler);

    // ---- One strategy after the other, for methods that choose among them.

    void trace_camera(const Ray& ray, int hero, RandomStream& random,
                      const SubpathTracer::Length& length);
    void trace_light(const LightNumbers& start, int hero, RandomStream& random,
                     const SubpathTracer::Length& length) {
        tracer_.from_light(start, hero, random, length, light_);
    }
    const Subpath& camera() const { return camera_; }
    const Subpath& light() const { return light_; }
    // Radiance of paths with `count` vertices, which the camera's path found.
    Vec3f found(std::size_t count, float* alpha = nullptr);
    // That of all lights sampled for the last of the first t vertices of the camera's path, and of
    // its connection with the last of the first s vertices of the light's path; s, t >= 2.
    Vec3f sampled(std::size_t t, RandomStream& random);
    Vec3f connected(std::size_t s, std::size_t t, RandomStream& random);
    // Of the connection of the last of s vertices with the camera; value 0 where nothing arrives.
    FilmSplat splatted(std::size_t s, Vec2f lens, RandomStream& random);

    // ---- For tests.

    // Takes this strategy alone (s, t), unweighted.
    std::optional<std::pair<std::size_t, std::size_t>> only;
    // A path of strategy (s, t), its weight, and the light of s <= 1 with the through of its edge.
    struct Weighed {
        std::size_t s = 0, t = 0;
        double weight = 0, through = 1;
        const LightEnd* end = nullptr;
        Vec3f radiance;
    };
    std::function<void(const Weighed&)> watch;

    std::int64_t rays() const { return tracer_.rays(); }
    std::int64_t lookups() const { return tracer_.lookups(); }

  private:
    Vec3f found_surface(std::size_t i);
    Vec3f found_glow(const Subpath::Glow& glow);
    Vec3f escaped(float* alpha);
    Vec3f from_light(const PathVertex& v, std::size_t t, const DrawnLight& drawn,
                     RandomStream& random);
    LightEndStrategies strategies(const LightEnd& light, std::size_t t, double found,
                                  double through, double back_density, bool is_end) const;
    double share(const Weighed& path, double own, double all) const;
    bool is_spared(Vec3f& radiance, RandomStream& random);
    double film_pixels() const {
        return static_cast<double>(scene_.view.width()) * scene_.view.height();
    }
    const SurfaceSet& surfaces() const { return scene_.view.surfaces; }

    const BdptScene& scene_;
    int depth_;
    double margin_;
    SubpathTracer tracer_;
    Subpath camera_, light_;
    std::vector<FilmSplat> splats_;
    bool has_roulette_ = false;
    bool has_light_paths_ = true;
    double brightest_ = 0;  // of the connections of this sample
};

}  // namespace gischt
