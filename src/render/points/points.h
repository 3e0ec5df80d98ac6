// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/method.h"
#include "render/points/points_params.h"

namespace gischt {

// Particles as points (Reeves 1983, "Particle systems: a technique for modeling a class of fuzzy
// objects").
std::unique_ptr<RenderMethod> make_points_method(const PointsParams& params);

inline constexpr std::string_view points_simulates =
    "particles as round points that scatter the light which reaches them, glow, or show their "
    "colour; surfaces behind and before them";
inline constexpr std::string_view points_leaves_out =
    "media: fluids without particles are not seen, but cast their shadows; depth of field, motion "
    "blur";
inline constexpr std::string_view points_cost =
    "particles, on graphics hardware or the processor (OpenGL 4.5)";

}  // namespace gischt
