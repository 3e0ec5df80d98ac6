// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/march/march_params.h"
#include "render/method.h"

namespace gischt {

// Ray marching with direct light (eq. 19): every camera ray is followed front to back in steps that
// suit the voxels and the extinction; each step adds emission and the light that arrives there
// directly from every light, dimmed by the media and blocked by the surfaces on its way. Front to
// back: L += T (1 - exp(-e ds)) / e (a L_e + s sum L_l P), T *= exp(-e ds), per channel.
std::unique_ptr<RenderMethod> make_march_method(const MarchParams& params);

inline constexpr std::string_view march_simulates =
    "absorption, emission and single scattering of point, spot, sun, sky and environment light; "
    "shadows of media and surfaces on each other; with a depth above 1 light scattered up to so "
    "many times; by choice an approximation of that";
inline constexpr std::string_view march_leaves_out =
    "at depth 1 light scattered twice or more (bright clouds stay dark) and that of glowing media "
    "and surfaces on others; glass, metal, lights with a size";
inline constexpr std::string_view march_cost =
    "pixels times samples times voxels along the ray, plus per frame about 0.1 microseconds per "
    "voxel and light for the grids of light; from depth to depth times directions and gathers";

}  // namespace gischt
