// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "fluid/procedural/params.h"
#include "grid/frame.h"
#include "shape/mesh_distance.h"

namespace gischt {

// Whether the frame has a velocity: there is a wind, or the shape or a blob changes its place.
bool is_moving(const ProceduralParams& params);

// The mesh of a shape of that kind, scaled and turned as asked for. Throws Error{Input}, which
// names the file, for one that is not closed.
MeshDistance filled_mesh(const MeshShapeParams& params, Mesh mesh);

// The fields `density`, and where asked for `temperature` (K), `flame`, `velocity` (m/s, of wind
// and shape together) and `surface` (m, a level set), all on the tiles that hold any density or
// surface, at a time in seconds. `up` is a unit axis. The cost is that of the noise near the shape;
// the result does not depend on the number of threads. `mesh` is for the shape of that name. Throws
// Error{Usage} for an empty box, values over time that are out of range, or a mesh that is missing.
Frame make_procedural(const ProceduralParams& params, const Vec3d& up, double time, Job& job,
                      const MeshDistance* mesh = nullptr);

}  // namespace gischt
