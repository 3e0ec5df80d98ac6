// SPDX-License-Identifier: Apache-2.0
#include "optics/sky.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "optics/atmosphere.h"

namespace gischt {
namespace {

constexpr int map_width = 360, map_height = 180;

// The observer stands a little above the ground, so that the land below the horizon fades into the
// haze instead of ending in an edge.
constexpr double observer_height = 100;  // m

void check(const char* key, double value, double low, double high) {
    if (value >= low && value <= high) return;
    throw Error(ErrorKind::Usage, "sky", fmt::format("{} is {}", key, value),
                fmt::format("it must be from {} to {}", low, high));
}

}  // namespace

Sky make_sky(const SkyState& state) {
    check("sun_elevation_degrees", state.sun_elevation_degrees, -18, 90);
    check("turbidity", state.turbidity, 1, 20);
    check("ground_albedo", state.ground_albedo, 0, 1);
    const Atmosphere air(state.turbidity, state.ground_albedo);
    const double elevation = radians(state.sun_elevation_degrees);
    const Vec3d sun{0, -std::cos(elevation), std::sin(elevation)};

    // The dome is even in x: one half is computed and mirrored.
    const int half = map_width / 2;
    std::vector<Vec3f> texels(static_cast<std::size_t>(half) * map_height);
    const auto direction = [](int x, int y) {
        // Column x of the half runs from the azimuth of -y over +x to that of +y.
        const double turn = pi * ((x + 0.5) / half - 0.5), v = pi * (y + 0.5) / map_height;
        return Vec3d{std::sin(v) * std::cos(turn), std::sin(v) * std::sin(turn), std::cos(v)};
    };
    parallel_for(map_height, 1, [&](int y) {
        for (int x = 0; x < half; ++x) {
            const auto spectrum = air.radiance(observer_height, direction(x, y), sun);
            texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(half) +
                   static_cast<std::size_t>(x)] = Vec3f(max(air.to_rgb(spectrum), Vec3d(0)));
        }
    });
    Sky sky;
    sky.dome = std::make_shared<EnvironmentMap>(map_width, map_height, [&](const Vec3d& d) {
        const double turn = std::atan2(d.y, std::abs(d.x)), v = std::acos(d.z);
        const int x = static_cast<int>((turn / pi + 0.5) * half);
        const int y = static_cast<int>(v / pi * map_height);
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(half) +
                      static_cast<std::size_t>(std::min(x, half - 1))];
    });

    Atmosphere::Spectrum disc = air.transmittance(observer_height, sun.z);
    for (std::size_t b = 0; b < disc.size(); ++b) disc[b] *= air.solar_irradiance()[b];
    sky.sun_irradiance = Vec3f(max(air.to_rgb(disc), Vec3d(0)));
    return sky;
}

}  // namespace gischt
