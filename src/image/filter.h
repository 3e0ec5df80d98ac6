// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "math/vec.h"

namespace gischt {

enum class FilterKind { Box, Gaussian, Mitchell, BlackmanHarris };

// The names of a scene file: box, gaussian, mitchell, blackman_harris. Throws Error{Usage}.
FilterKind filter_kind(std::string_view name);
// The radius in pixels at which a filter is commonly used: 0.5, 1.5, 2, 1.5.
float default_radius(FilterKind kind);

// Where in the image plane a sample of a pixel lies, and how it counts.
struct FilterSample {
    Vec2f offset;      // from the pixel's centre, in pixels, each component in [-radius, radius]
    float weight = 1;  // 1, or -1 in the negative lobes of Mitchell
};

// Reconstruction filter, used by importance sampling: a sample is placed with a density
// proportional to |f| around its own pixel and counts for that pixel only, so that tiles and
// threads never share a pixel (Ernst, Stamminger, Greiner 2006, "Filter importance sampling"). f(x,
// y) = f1(x) f1(y), f1 zero outside the radius:
//   Box             1
//   Gaussian        exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2), s = radius / 3
//   Mitchell        B = C = 1/3, stretched to the radius (Mitchell & Netravali 1988)
//   BlackmanHarris  the four-term window (Harris 1978)
// Mitchell's sharpness costs noise: 1 sample in 16 counts negative. Below 16 samples per
// pixel take one of the others.
class ReconstructionFilter {
  public:
    // Radius in pixels; 0 or less takes the default. Throws Error{Usage} above 16.
    explicit ReconstructionFilter(FilterKind kind = FilterKind::BlackmanHarris, float radius = 0);

    FilterKind kind() const { return kind_; }
    float radius() const { return radius_; }
    // f1 at a distance in pixels from the centre; its largest value is that at 0.
    double profile(double x) const;
    // The sample for two numbers in [0,1). Keeps the stratification of u.
    FilterSample sample(Vec2f u) const;
    // Mean of weight over samples: (integral of f) / (integral of |f|); 1 for positive filters.
    double mean_weight() const { return mean_weight_; }

  private:
    float sample_axis(float u, float& sign) const;

    FilterKind kind_;
    float radius_;
    double mean_weight_ = 1;
    std::vector<float> cdf_;  // of |f1| at equidistant points from 0 to radius
};

}  // namespace gischt
