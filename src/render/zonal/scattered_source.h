// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/medium.h"
#include "optics/surface.h"

namespace gischt {

// What scatters towards a viewer at a point of a medium, beside the light of its first scattering.
struct ScatteredLight {
    // Radiance that is scattered evenly with the reduced coefficient s (1 - g), and seen through
    // media whose scattering is reduced like that; and what of it is light of the first scattering,
    // seen through the media as they are. W/(m^2 sr).
    Vec3f reduced, first;
    // Integral over the sphere of what arrives times the phase function, scattered with s and seen
    // through the media as they are. W/(m^2 sr).
    Vec3f plain;
};

// The light of all scatterings but the first, as a method found it on a grid. Safe to use from
// several threads.
class ScatteredSource {
  public:
    virtual ~ScatteredSource() = default;
    // `forward`: unit, the way of the camera ray; light leaves against it.
    virtual ScatteredLight in_medium(const Vec3d& point, const Vec3d& forward,
                                     const Medium& medium) const = 0;
    // Irradiance over pi on a surface; W/(m^2 sr).
    virtual ScatteredLight on_surface(const SurfaceHit& hit) const = 0;
};

}  // namespace gischt
