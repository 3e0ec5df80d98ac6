// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"

namespace gischt {

// Light that arrives at a point from one direction. An integral over directions of L(w) f(w) is
// estimated by weight * f(direction), for instance single scattering by
// weight * transmittance * s * phase.
struct LightSample {
    Vec3d direction;  // unit, from the point towards the light
    double distance = std::numeric_limits<double>::infinity();  // metres to the light
    Vec3f weight;   // W/m^2: radiance / pdf, or the irradiance on a facing plane of a delta light
    float pdf = 0;  // 1/sr; 0 for a delta light, which no other sampler can hit
};

// The ball that holds a light at a finite place, metres; a radius of 0 for a point.
struct LightPlace {
    Vec3d center;
    double radius = 0;
};

// A source of light at one moment. Immutable, safe to use from several threads.
class Light {
  public:
    virtual ~Light() = default;

    // One direction from which light may arrive at a point, for u in [0,1)^2. The weight is zero
    // where none arrives.
    virtual LightSample sample(const Vec3d& point, Vec2f u) const = 0;
    // The density in 1/sr with which sample() would take a direction; 0 for delta lights.
    virtual float pdf(const Vec3d& point, const Vec3d& direction) const = 0;
    // Radiance that arrives from infinitely far away along -direction, W/(m^2 sr); zero for lights
    // at a finite place and for delta lights.
    virtual Vec3f radiance(const Vec3d& direction) const = 0;
    // The light comes from a single direction at each point: one sample tells all.
    virtual bool is_delta() const = 0;
    // The light comes from infinitely far away and is the same everywhere.
    virtual bool is_infinite() const = 0;
    // Mean over all directions of the light that arrives at a point (W/(m^2 sr)), without shadow:
    // fluence / 4 pi. For ambient terms and to choose among lights; exact.
    virtual Vec3f mean_radiance(const Vec3d& point) const = 0;
    // Where it is; nothing for a light at infinity.
    virtual std::optional<LightPlace> place() const { return std::nullopt; }

    std::string name;            // of the scene file; may be empty
    std::string group;           // of lights with a layer of the picture of their own; may be empty
    bool camera_visible = true;  // lights at infinity only: whether the camera sees radiance()
};

using LightPtr = std::shared_ptr<const Light>;

// Sum of radiance() over the lights at infinity, or only over those that the camera sees.
Vec3f infinite_radiance(const std::vector<LightPtr>& lights, const Vec3d& direction,
                        bool camera_ray);

}  // namespace gischt
