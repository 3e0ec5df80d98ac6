// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/environment.h"

namespace gischt {

// A clear sky for a given elevation of the sun, computed from the atmosphere.
struct Sky {
    // The dome without the sun's disc, W/(m^2 sr); below the horizon the ground through its haze.
    // In the map's frame (z up) the sun stands over -y.
    EnvironmentMap::Ptr dome;
    // Irradiance of the sun on a plane that faces it, W/m^2, after the atmosphere; zero when the
    // sun is down.
    Vec3f sun_irradiance;
};

struct SkyState {
    double sun_elevation_degrees = 35;  // from -18 (night) to 90
    double turbidity = 2;               // 1 pure air, 2 clear, 3 slightly hazy, 6 hazy
    double ground_albedo = 0.3;
    bool operator==(const SkyState&) const = default;
};

// About 0.3 s on two cores. Throws Error{Usage} for a state out of range.
Sky make_sky(const SkyState& state);

}  // namespace gischt
