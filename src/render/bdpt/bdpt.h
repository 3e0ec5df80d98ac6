// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/bdpt/bdpt_params.h"
#include "render/method.h"

namespace gischt {

// Bidirectional path tracing through media and surfaces (Lafortune & Willems 1993 and 1996; Veach &
// Guibas 1995; Veach 1997, chapter 10): paths from the camera and from the lights, joined in every
// way that there is, without bias. It also finds light of points and suns behind glass.
std::unique_ptr<RenderMethod> make_bdpt_method(const BdptParams& params);

inline constexpr std::string_view bdpt_simulates =
    "all that path does, also light of points and suns through glass: paths from the camera and "
    "from the lights, joined";
inline constexpr std::string_view bdpt_leaves_out = "motion blur, layers of the picture";
inline constexpr std::string_view bdpt_cost =
    "as path, per sample several times dearer; pays where light has to find a narrow way";

// Throws Error{Usage} for the settings that films with a layer of light paths cannot obey.
void refuse_noise_of_light_paths(const RenderSettings& settings, std::string_view method);

}  // namespace gischt
