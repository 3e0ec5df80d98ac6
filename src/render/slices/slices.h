// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/method.h"
#include "render/slices/slices_params.h"

namespace gischt {

// Stacks of slices across the three axes (Dobashi et al. 2000 and others before): the stack whose
// axis is nearest to the view direction is drawn back to front, each slice standing for the slab
// around it. Light reaches each cell of the grid once, before. Or slices across the half vector
// between light and view (render/slices/half_angle.h).
std::unique_ptr<RenderMethod> make_slices_method(const SlicesParams& params);

inline constexpr std::string_view slices_simulates =
    "absorption, emission and single scattering of point, spot and sun light on a regular grid; "
    "light of the sky as if it were scattered evenly; shadows of media and surfaces on each other";
inline constexpr std::string_view slices_leaves_out =
    "details smaller than the grid's cells, light scattered twice or more, shadows of surfaces in "
    "the light of the sky on surfaces, depth of field, motion blur";
inline constexpr std::string_view slices_cost =
    "pixels times slices, on graphics hardware or the processor (OpenGL 4.5); the light once";

}  // namespace gischt
