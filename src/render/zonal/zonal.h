// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/method.h"
#include "render/zonal/zonal_params.h"

namespace gischt {

// Finite elements (Rushmeier & Torrance 1987, "The zonal method for calculating light intensities
// in the presence of a participating medium"): light in equilibrium between the zones of a coarse
// grid and the patches of surfaces among them, then gathered along the camera's rays.
std::unique_ptr<RenderMethod> make_zonal_method(const ZonalParams& params);

inline constexpr std::string_view zonal_simulates =
    "absorption, emission and scattering to every depth between the media and evenly scattering "
    "surfaces in their box; the first scattering exactly, further ones on a coarse grid";
inline constexpr std::string_view zonal_leaves_out =
    "details of multiply scattered light smaller than a zone; but with ordinates, its direction "
    "(the similarity relation stands in); light exchanged with surfaces outside of the media's box";
inline constexpr std::string_view zonal_cost =
    "per frame zones times lines, again for each iteration, or the square of the zones for a "
    "matrix; "
    "then pixels times samples times voxels along the ray; anew for each frame of a moving fluid";

}  // namespace gischt
