// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/method.h"
#include "render/mlt/mlt_params.h"

namespace gischt {

// Metropolis light transport (Veach & Guibas 1997) in the space of the random numbers of
// bidirectional path tracing, see mlt_chain.h. Samples per pixel are mutations per pixel.
std::unique_ptr<RenderMethod> make_mlt_method(const MltParams& params);

inline constexpr std::string_view mlt_simulates =
    "all that bdpt does, by chains of paths that are varied where they bring light";
inline constexpr std::string_view mlt_leaves_out = "motion blur, layers of the picture";
inline constexpr std::string_view mlt_cost =
    "pixels times mutations; pays where few paths bring most of the light";

}  // namespace gischt
