// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "math/pixel_sampler.h"
#include "render/march/march_scene.h"

namespace gischt {

// Points of a marched ray at which light is gathered from all around: spread evenly over the light
// that is scattered on the ray towards its origin, so many per unit of its share.
class GatherPlaces {
  public:
    // 0 per unit: every step gathers. `first` in [0,1) places the first one.
    GatherPlaces(double per_unit, float first)
        : spacing_(per_unit > 0 ? static_cast<float>(1 / per_unit) : 0), next_(first * spacing_) {}

    // The weight of a gather on a step that scatters `share` of the light; 0: none is due. Its
    // expectation is 1.
    float weight_of(float share) {
        if (!(share > 0)) return 0;
        if (spacing_ == 0) return 1;
        sum_ += share;
        if (sum_ <= next_) return 0;
        const float due = std::ceil((sum_ - next_) / spacing_);
        next_ += due * spacing_;
        return due * spacing_ / share;
    }

  private:
    float spacing_, next_, sum_ = 0;
};

// Multiple scattering by marching, eq. 20: what arrives at a point is gathered from M directions
// drawn from the phase function, so that each weighs 1/M; each of them is marched by eq. 19 and
// gathers in its turn, up to the depth. Deeper rays are thinned: longer steps, and from level to
// level fewer directions at fewer places.
//
// A ray of level k carries light that is scattered k times between it and the camera; camera rays
// (level 0) are RayMarcher's. The sky's own light at a point of a camera ray comes from grids
// (march_scene.h); at deeper points the gathering rays find it, weighed against directions drawn
// from the sky by the balance heuristic (Veach & Guibas 1995).
class DeepMarch {
  public:
    // Gathers where the scene's depth is above 1. One per thread.
    explicit DeepMarch(const MarchScene& scene);

    // The random numbers of one camera ray.
    void begin(HashStream numbers) { numbers_ = numbers; }
    GatherPlaces places(int level);
    // Radiance that is scattered at a point of a ray of a level, per scattering coefficient,
    // without what comes straight from lights; `forward` is the ray's unit direction.
    Vec3f at_medium(std::size_t medium, const Vec3d& point, const Vec3d& forward, int level);
    // Irradiance on a surface, likewise.
    Vec3f at_surface(const SurfaceHit& hit, int level);

    std::int64_t rays = 0, lookups = 0;

  private:
    // What a ray of a level can still carry.
    bool scatters(int level) const { return level < scene_.depth; }
    bool sees_sky(int level) const { return level >= 2 && !scene_.broad.empty(); }
    bool carries(int level) const {
        return level <= scene_.depth && (scatters(level) || sees_sky(level) || has_glow_);
    }
    int directions(int level) const;

    Vec3f follow(Ray ray, int level, float pdf);
    Vec3f march(const Ray& ray, int level, Vec3f& transmittance);
    Vec3f from_lights(std::size_t medium, const Vec3d& point, const Vec3d& forward);
    Vec3f shade(const SurfaceHit& hit, int level);
    Vec3f behind(const Vec3d& direction, float pdf) const;

    const MarchScene& scene_;
    std::vector<const Medium*> media_;
    std::vector<const Light*> drawn_;  // of the broad lights those to draw directions from
    bool has_glow_ = false;            // a medium or a surface glows
    HashStream numbers_{0};
};

}  // namespace gischt
