// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "grid/frame.h"

namespace gischt {

// One component of a field on the lattice of cells of another transform, by trilinear interpolation
// at the cells' centres; the tiles cover the box of the source. For fields of one frame whose grids
// do not lie on each other.
Field resample(const Field& source, int axis, const Transform& to_world, Job& job);

}  // namespace gischt
