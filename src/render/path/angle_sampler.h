// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "math/ray.h"
#include "optics/light.h"

namespace gischt {

// Distances along a ray by the angle under which lights at finite places see them (Kulla & Fajardo
// 2012, "Importance sampling techniques for path tracing in participating media"): the density
// 1 / (d^2 + (t - t_near)^2) follows the square law of a point at the distance d from the ray. Of
// several lights each has a share by how much of its light the ray would get. Keeps its memory from
// ray to ray; one per thread.
class AngleSampler {
  public:
    // For t in [t0, t1], which may have no end, along a ray of unit direction.
    void aim(std::span<const Light* const> lights, const Ray& ray, double t0, double t1);
    // No light shines there.
    bool is_empty() const { return arcs_.empty(); }

    // The distance for u in [0, 1).
    double sample(float u) const;
    // The density of these at t, 1/m.
    float density(double t) const;

  private:
    // What a light sees of the ray.
    struct Arc {
        double nearest = 0, distance = 0;  // t of the point next to the light, metres from there
        double begin = 0, angle = 0;       // radians
        double share = 0;
    };
    double t0_ = 0, t1_ = 0;
    std::vector<Arc> arcs_;
};

}  // namespace gischt
