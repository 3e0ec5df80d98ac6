// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "fluid/procedural/params.h"
#include "grid/frame.h"

namespace gischt {

// Whether the frame has a velocity: there is a wind, or the shape or a blob changes its place.
bool is_moving(const ProceduralParams& params);

// The fields `density`, and where asked for `temperature` (K), `flame` and `velocity` (m/s, of wind
// and shape together), all on the tiles that hold any density, at a time in seconds. `up` is a unit
// axis. The cost is that of the noise near the shape; the result does not depend on the number of
// threads. Throws Error{Usage} for an empty box or values over time that are out of range.
Frame make_procedural(const ProceduralParams& params, const Vec3d& up, double time, Job& job);

}  // namespace gischt
