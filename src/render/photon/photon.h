// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/method.h"
#include "render/photon/photon_params.h"

namespace gischt {

// Photon mapping in two passes (Jensen & Christensen 1998, "Efficient simulation of light transport
// in scenes with participating media using photon maps"): light is carried from its sources and
// kept where it is scattered, then seen from the camera. Progressive: map after map is thrown away,
// each with a smaller radius (Knaus & Zwicker 2011), so that the mean converges to the truth.
std::unique_ptr<RenderMethod> make_photon_method(const PhotonParams& params);

inline constexpr std::string_view photon_simulates =
    "absorption, emission and scattering up to any depth, caustics on surfaces and in media, of "
    "points and suns behind glass too";
inline constexpr std::string_view photon_leaves_out =
    "what is finer than its radius, which shrinks with the samples; motion of media and surfaces; "
    "media without end";
inline constexpr std::string_view photon_cost =
    "photons per map, and pixels times samples times photons near a ray";

}  // namespace gischt
