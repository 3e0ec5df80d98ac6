// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "optics/light.h"
#include "optics/phase.h"

namespace gischt {

// A part of the sky seen as one direction.
struct SkyDirection {
    Vec3d direction;        // unit, towards the sky: the centroid of the light in the part
    float solid_angle = 0;  // sr
    Vec3f radiance;         // mean over the part, W/(m^2 sr)
    float mean_cosine = 1;  // between the part's directions and its centre: how wide it is
};

// Divides the sphere into about `count` parts, small where much light comes from or where the phase
// function sends it towards the viewer: a quadtree on the faces of a cube that splits the part of
// the largest share until there are enough. `forward` are directions in which the viewer looks at
// the medium. The parts cover the sphere and hold all the light of `lights`.
std::vector<SkyDirection> sky_directions(std::span<const Light* const> lights,
                                         const PhaseFunction& phase, std::span<const Vec3d> forward,
                                         int count);

}  // namespace gischt
