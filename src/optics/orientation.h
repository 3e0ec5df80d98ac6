// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/units.h"
#include "math/transform.h"

namespace gischt {

// The rotation that turns z into the unit vector `up` on the shortest way: the identity for z up; x
// stays x and y becomes -z for y up.
inline Transform up_frame(const Vec3d& up) {
    const Vec3d z{0, 0, 1}, axis = cross(z, up);
    const double sine = length(axis), cosine = up.z;
    if (sine < 1e-12) return cosine > 0 ? Transform{} : Transform::rotation({1, 0, 0}, pi);
    return Transform::rotation(axis / sine, std::atan2(sine, cosine));
}

// Unit vector towards a point of the sky (or of an orbit). Azimuth 0 is -y for z up and +z for y
// up, the side from which a scene is looked at by custom; it grows counterclockwise seen from
// above, so that 90 degrees is +x. Elevation counts from the horizon.
inline Vec3d horizon_direction(double azimuth_degrees, double elevation_degrees, const Vec3d& up) {
    const double a = radians(azimuth_degrees), e = radians(elevation_degrees);
    return up_frame(normalize(up))
        .vector({std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)});
}

}  // namespace gischt
