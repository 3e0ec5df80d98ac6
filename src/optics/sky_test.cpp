// SPDX-License-Identifier: Apache-2.0
#include "optics/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/units.h"
#include "image/color.h"
#include "optics/atmosphere.h"

namespace gischt {
namespace {

Vec3d towards(double azimuth, double elevation) {
    const double a = radians(azimuth), e = radians(elevation);
    return {std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)};
}

const Sky& noon() {
    static const Sky sky = make_sky({.sun_elevation_degrees = 60, .turbidity = 2});
    return sky;
}

// Optical depth of the pure atmosphere at 550 nm: 0.097 (Bucholtz 1995), here at the band of
// 540 nm: 0.105. Towards the zenith the column is the scale height.
TEST(Atmosphere, ClearAirHasThePublishedOpticalDepth) {
    const Atmosphere air(1, 0.3);
    const double depth = -std::log(air.transmittance(0, 1)[4]);
    // Ozone adds 3.091e-25 m^2 * 8.06e22 / m^2.
    EXPECT_NEAR(depth, 1.24062e-6 / std::pow(0.54, 4) * 8000 + 0.0249, 2e-3);
    // Twice as long at 60 degrees from the zenith; the curvature takes less than 1 %.
    EXPECT_NEAR(std::log(air.transmittance(0, 0.5)[4]) / -depth, 2, 0.02);
    EXPECT_EQ(air.transmittance(0, -0.2)[4], 0);
    EXPECT_GT(air.transmittance(50000, -0.05)[4], 0);
}

// Measured and modelled clear skies: the sun delivers about 1000 W/m^2 of its 1361, and half of it
// in the visible; the sky is a tenth to a fifth of the sun's horizontal irradiance.
TEST(Sky, EnergyIsThatOfAClearDay) {
    const double sun = luminance(noon().sun_irradiance);
    EXPECT_GT(sun, 500);
    EXPECT_LT(sun, 700);
    double dome = 0;
    const EnvironmentMap& map = *noon().dome;
    for (int y = 0; y < map.height() / 2; ++y) {
        const double v = pi * (y + 0.5) / map.height();
        for (int x = 0; x < map.width(); ++x) {
            dome += luminance(Vec3d(map.texel(x, y))) * std::cos(v) * std::sin(v);
        }
    }
    dome *= 2 * pi * pi / (map.width() * map.height());
    const double horizontal = sun * std::sin(radians(60));
    EXPECT_GT(dome / horizontal, 0.08);
    EXPECT_LT(dome / horizontal, 0.25);
}

TEST(Sky, IsBlueAboveAndBrightAtTheHorizon) {
    const Vec3f zenith = noon().dome->radiance(towards(180, 85));
    EXPECT_GT(zenith.z, 1.8f * zenith.x);
    EXPECT_GT(zenith.z, zenith.y);
    EXPECT_GT(zenith.y, zenith.x);
    const Vec3f horizon = noon().dome->radiance(towards(180, 3));
    EXPECT_GT(luminance(horizon), 1.5 * luminance(zenith));
    // Paler than the zenith.
    EXPECT_LT(horizon.z / horizon.x, zenith.z / zenith.x);
    // The glow of the haze is around the sun.
    const float near = luminance(noon().dome->radiance(towards(0, 65)));
    EXPECT_GT(near, 2 * luminance(noon().dome->radiance(towards(180, 65))));
}

TEST(Sky, LowSunIsRedAndDim) {
    const Sky evening = make_sky({.sun_elevation_degrees = 2, .turbidity = 2});
    EXPECT_LT(luminance(evening.sun_irradiance), 0.35 * luminance(noon().sun_irradiance));
    EXPECT_GT(evening.sun_irradiance.x, 3 * evening.sun_irradiance.z);
    const Vec3f noon_sun = noon().sun_irradiance;
    EXPECT_LT(noon_sun.x / noon_sun.z, 1.4);
    const Vec3f west = evening.dome->radiance(towards(0, 2));
    EXPECT_GT(west.x, west.z);
    // Opposite: still bluish above.
    const Vec3f above = evening.dome->radiance(towards(180, 60));
    EXPECT_GT(above.z, above.x);
}

TEST(Sky, TwilightFades) {
    float before = luminance(noon().dome->mean());
    for (const double elevation : {5.0, -2.0, -6.0, -12.0}) {
        const Sky sky = make_sky({.sun_elevation_degrees = elevation});
        const float mean = luminance(sky.dome->mean());
        EXPECT_LT(mean, before) << elevation;
        EXPECT_GT(mean, 0) << elevation;
        EXPECT_EQ(max_component(sky.sun_irradiance) > 0, elevation > 0) << elevation;
        before = mean;
    }
}

TEST(Sky, IsEvenAcrossTheSunsMeridianAndFinite) {
    const EnvironmentMap& map = *noon().dome;
    for (int y = 0; y < map.height(); ++y) {
        for (int x = 0; x < map.width(); ++x) {
            const Vec3f& c = map.texel(x, y);
            ASSERT_TRUE(std::isfinite(c.x + c.y + c.z));
            ASSERT_GE(min_component(c), 0);
        }
    }
    for (const double azimuth : {20.0, 75.0, 130.0}) {
        const Vec3f a = noon().dome->radiance(towards(azimuth, 25));
        const Vec3f b = noon().dome->radiance(towards(-azimuth, 25));
        EXPECT_NEAR(a.x, b.x, 1e-4f * a.x);
    }
}

TEST(Sky, RefusesWhatIsNoSky) {
    EXPECT_THROW(make_sky({.sun_elevation_degrees = 91}), Error);
    EXPECT_THROW(make_sky({.turbidity = 0.5}), Error);
    EXPECT_THROW(make_sky({.ground_albedo = 2}), Error);
}

}  // namespace
}  // namespace gischt
