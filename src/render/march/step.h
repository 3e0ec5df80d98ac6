// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "math/vec.h"

namespace gischt {

// One step of a march, `ds` metres through an even extinction e (1/m), of eq. 19.

// (1 - exp(-e ds)) / e, which is ds where nothing absorbs.
inline float source_length(float e, float transmittance, float ds) {
    const float x = e * ds;
    return x < 1e-3f ? ds * (1 - 0.5f * x) : (1 - transmittance) / e;
}
inline Vec3f source_length(const Vec3f& e, const Vec3f& transmittance, float ds) {
    return {source_length(e.x, transmittance.x, ds), source_length(e.y, transmittance.y, ds),
            source_length(e.z, transmittance.z, ds)};
}

// Where in the step the light is taken that it scatters, metres from its begin: for evenly
// distributed u in [0,1) in proportion to what is seen of it, so that the light may change within
// the step. By the mean extinction of the channels.
inline double lit_place(float u, const Vec3f& e, float ds) {
    const float x = (e.x + e.y + e.z) * (1 / 3.0f) * ds;
    const float share =
        x < 1e-2f ? u - 0.5f * x * u * (1 - u) : -std::log1p(-u * (1 - std::exp(-x))) / x;
    return static_cast<double>(share * ds);
}

}  // namespace gischt
