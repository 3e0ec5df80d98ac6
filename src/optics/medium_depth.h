// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "optics/medium.h"

namespace gischt {

// How finely optical depths are summed.
struct DepthSteps {
    // Largest step in cells of the medium. The midpoint rule's error falls with its square.
    double step = 1;
    // Stops once the depth of the weakest channel that is not clear exceeds this: exp(-16) = 1e-7.
    float enough = 16;
};

// Integral of the density along a ray through one medium in metres (times density 1): the optical
// depth (eq. 16) per unit of cross section. Deterministic: midpoint rule in equal steps inside each
// block, exact in homogeneous media. `lookups`, where given, counts densities read.
float density_integral(const Medium& medium, const Ray& ray, const DepthSteps& steps,
                       std::int64_t* lookups = nullptr);

// Optical depth per channel, and its exponential, through several media that overlap freely.
Vec3f optical_depth(std::span<const std::shared_ptr<const Medium>> media, const Ray& ray,
                    const DepthSteps& steps = {}, std::int64_t* lookups = nullptr);

// Densities at t0 + i dt along a ray, i < out.size(), dt > 0; zero where there is no medium.
void densities_on_line(const Medium& medium, const Ray& ray, double t0, double dt,
                       std::span<float> out);

}  // namespace gischt
