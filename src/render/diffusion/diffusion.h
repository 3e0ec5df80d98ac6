// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/diffusion/diffusion_params.h"
#include "render/method.h"

namespace gischt {

// Multiple scattering as a diffusion process (Stam 1995): the first scattering exactly, all others
// as the solution of a diffusion equation, gathered along the camera's rays.
std::unique_ptr<RenderMethod> make_diffusion_method(const DiffusionParams& params);

inline constexpr std::string_view diffusion_simulates =
    "absorption, emission and scattering to every depth within dense media: the first scattering "
    "exactly, all further ones as diffusion";
inline constexpr std::string_view diffusion_leaves_out =
    "the directions of multiply scattered light but for one lobe, light from one part of the media "
    "to another across clear air, light from surfaces; wrong where media are thin";
inline constexpr std::string_view diffusion_cost =
    "per frame some 3 microseconds per cell and light, then pixels times samples times voxels "
    "along "
    "the ray";

}  // namespace gischt
