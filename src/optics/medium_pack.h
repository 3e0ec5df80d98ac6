// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "grid/brick_volume.h"

namespace gischt {

// Fields of a frame made ready for a medium. All throw Error{Input} when a field is missing or is a
// vector where a scalar belongs, and tell the job of values that are not finite.

// A scalar, on the lattice of cells of another field if `lattice` is given.
BrickVolume pack_scalar(const Frame& frame, const std::string& name, const BrickOptions& options,
                        const Transform* lattice, Job& job);

// Density times colour, per channel, on the lattice and with the bricks of the density: divided by
// the density this is a colour that does not fade where the density ends. The colour is the vector
// `name`, or the scalars name_r, name_g, name_b; values are taken into [0,1], and the job is told
// of larger ones.
std::vector<BrickVolume> pack_dyed_density(const Frame& frame, const std::string& density,
                                           const std::string& name, const BrickVolume& like,
                                           Job& job);

}  // namespace gischt
