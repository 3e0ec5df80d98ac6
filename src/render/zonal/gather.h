// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "render/method.h"
#include "render/zonal/scattered_march.h"

namespace gischt {

// The last leg of the methods that find the light on a grid: each camera ray takes emission and the
// light scattered once as path tracing does at depth 1, without any grid, and marches through the
// media for all further scatterings, which vary slowly. The picture converges with the samples, to
// the grid's light.
//
// Where the source is of the reduced kind, L = L_1 + integral of s (1 - g) (T' J' - T J_1), T' and
// J' being those of media with reduced scattering: what is added to the first scattering L_1 is all
// light of the reduced media without what would count twice (after Nakajima & Tanaka 1988).
RenderResult render_gathered(const View& view, const RenderSettings& settings,
                             std::string_view method, const ScatteredSource& source,
                             const GatherParams& params, Job& job);

// Refuses, naming `method` and what to take instead, what no grid of light can do here: media
// without end, media or surfaces that move while the film is exposed, insides of surfaces, and
// surfaces that scatter in another way than Lambert's. Returns the box around the media. Throws
// Error{Usage}.
Box3d check_gathered(const View& view, std::string_view method);

}  // namespace gischt
