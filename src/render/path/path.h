// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/method.h"
#include "render/path/path_params.h"

namespace gischt {

// Monte-Carlo path tracing through media and surfaces (Kajiya 1986; Novak et al. 2018, "Monte Carlo
// methods for volumetric light transport simulation"): no bias, any number of scatterings up to
// `depth`, with next-event estimation and multiple importance sampling.
std::unique_ptr<RenderMethod> make_path_method(const PathParams& params);

inline constexpr std::string_view path_simulates =
    "absorption, emission and scattering up to any depth, between media and surfaces, of all "
    "lights: the reference";
inline constexpr std::string_view path_leaves_out =
    "caustics of points and suns through glass, which it cannot find";
inline constexpr std::string_view path_cost =
    "pixels times samples times scatterings; noise falls with the square root of the samples";

}  // namespace gischt
