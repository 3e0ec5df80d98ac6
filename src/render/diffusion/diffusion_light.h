// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "optics/view.h"
#include "render/diffusion/diffusion_params.h"
#include "render/diffusion/light_diffusion.h"
#include "render/zonal/scattered_source.h"

namespace gischt {

// The media of a view on cubic cells, with what they scatter of the light that comes straight from
// the lights and from what glows.
DiffusionProblem diffusion_problem(const View& view, const Box3d& media,
                                   const DiffusionParams& params, Job& job);

// Light of all scatterings but the first by diffusion, ready for the gather: (phi + 3 g F w) /
// (4 pi) towards w, but not below 0. Warns the job when the media are so thin that light does not
// diffuse in them. Throws Error{Usage} where a surface stands among them.
std::unique_ptr<ScatteredSource> light_by_diffusion(const View& view, const Box3d& media,
                                                    const DiffusionParams& params, Job& job);

}  // namespace gischt
