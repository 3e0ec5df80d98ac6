// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/job.h"
#include "optics/view.h"
#include "render/path/path_params.h"
#include "render/path/sun_source.h"

namespace gischt {

// A view made ready for path tracing.
struct PathScene {
    // Throws Error{Usage} where the view asks for what the method cannot do.
    PathScene(const View& the_view, const PathParams& the_params, Job& job);

    const View& view;
    const PathParams& params;
    std::vector<const Medium*> media;
    bool is_grey = true;       // all channels of all media have the same extinction
    bool is_emissive = false;  // a medium glows

    std::vector<SunSource> suns;      // reached by sampling them only
    std::vector<const Light*> local;  // at finite places
    std::vector<const Light*> broad;  // at infinity, sampled and met by chance
    std::vector<const Light*> even;   // the same from everywhere: met by chance only

    // Radiance of what a path meets at infinity, the suns left out unless they are asked for.
    Vec3f even_radiance() const;
};

}  // namespace gischt
