// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/march/gpu_march_params.h"
#include "render/method.h"

namespace gischt {

// The march of march.h in a shader: the media and their light are brought onto a regular grid, and
// one pass follows the rays of all pixels through it.
std::unique_ptr<RenderMethod> make_gpu_march_method(const GpuMarchParams& params);

inline constexpr std::string_view gpu_march_simulates =
    "absorption, emission and single scattering of point, spot and sun light on a regular grid; "
    "light of the sky as if it were scattered evenly; shadows of media and surfaces on each other";
inline constexpr std::string_view gpu_march_leaves_out =
    "details smaller than the grid's cells, light scattered twice or more, shadows of surfaces in "
    "the light of the sky on surfaces, depth of field, motion blur";
inline constexpr std::string_view gpu_march_cost =
    "pixels times cells along the ray that hold something, on graphics hardware or the processor "
    "(OpenGL 4.5); the light once";

}  // namespace gischt
