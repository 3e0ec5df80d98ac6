// SPDX-License-Identifier: Apache-2.0
#include "optics/placed_media.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/color.h"
#include "optics/atmosphere.h"
#include "optics/medium_depth.h"

namespace gischt {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Through all of a section's media, per channel.
Vec3d depth_of(const PlacedMediumParams& params, const Ray& ray) {
    Vec3d sum;
    for (const auto& m : place_media(params, 0, {0, 0, 1})) {
        const double strongest = static_cast<double>(*m->optical_depth(ray, ray.t_min, ray.t_max));
        sum += strongest / static_cast<double>(m->strength()) *
               Vec3d(m->cross_sections().extinction());
    }
    return sum;
}

TEST(PlacedMedia, StandWhereTheyArePlaced) {
    BoxMedium box;
    box.medium.extinction = Keyed<Vec3d>(Vec3d(1, 2, 3));
    box.center = Keyed<Vec3d>(Vec3d(0, 5, 0));
    box.size = {1, 2, 4};
    box.rotation_degrees = Keyed<Vec3d>(Vec3d(90, 0, 0));  // z becomes -y
    EXPECT_NEAR(depth_of(box, {{0, 0, 0}, {0, 1, 0}}).z, 12, 1e-5);
    SphereMedium ball;
    ball.medium.extinction = Keyed<Vec3d>(Vec3d(2));
    ball.radius = Keyed<double>(3.0);
    EXPECT_NEAR(depth_of(ball, {{0, 0, 0}, {0, 1, 0}}).x, 6, 1e-5);
    UnboundedMedium fog;
    EXPECT_NEAR(depth_of(fog, {{0, 0, 0}, {0, 1, 0}, 0, 50}).x, 0.5, 1e-6);
    HeightFog low;
    low.base = -3;
    low.up = Vec3d(0, 2, 0);
    EXPECT_NEAR(depth_of(low, {{0, 0, 0}, {0, 1, 0}}).x, 0.1 * std::exp(-0.3), 1e-6);
}

TEST(PlacedMedia, RefuseWhatBelongsToFluids) {
    const auto fails = [](const char* key, const Value& value, const char* type) {
        Value table;
        table.set("type", Value(type));
        table.set(key, value);
        EXPECT_THROW(read(table, placed_media_variants()), Error) << key;
    };
    fails("density_field", Value("soot"), "box");
    fails("emission_field", Value("heat"), "sphere");
    fails("emission", Value("flame"), "box");
    fails("emission", Value("blackbody"), "unbounded");
    fails("emission", Value("blackbody"), "height_fog");
    fails("scale_height", Value(0.0), "height_fog");
    fails("temperature", Value(900.0), "height_fog");
}

// The depth of clear air at the zenith: 8 km of molecules, 0.0464 / 1.2 km of haze ... in each
// channel the sum of coefficient times scale height.
TEST(PlanetAir, HasTheZenithDepthOfItsLayers) {
    const auto earth = Atmosphere::coefficients(2);
    const Vec3d expected = 8000 * (1 - std::exp(-12.5)) * earth.air_scattering +
                           1200.0 * (earth.haze_scattering + earth.haze_absorption) +
                           Atmosphere::ozone_reach * earth.ozone_absorption;
    const Vec3d depth = depth_of(PlanetAir{}, {{0, 0, 0}, {0, 0, 1}});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(depth[c] / expected[c], 1, 1e-5);
    // Blue light is scattered most, and molecules alone take about a quarter of it.
    EXPECT_GT(depth.z, depth.y);
    EXPECT_GT(depth.y, depth.x);
    PlanetAir pure;
    pure.turbidity = 1;
    pure.ozone = 0;
    EXPECT_NEAR(depth_of(pure, {{0, 0, 0}, {0, 0, 1}}).z, 0.24, 0.04);
}

// In the zenith the three channels are those of the spectral sky to the first order.
TEST(PlanetAir, AgreesWithTheSpectralSky) {
    const Atmosphere sky(2, 0.3);
    Atmosphere::Spectrum sun = sky.transmittance(0, 1);
    for (std::size_t b = 0; b < sun.size(); ++b) sun[b] *= sky.solar_irradiance()[b];
    const Vec3d expected = sky.to_rgb(sun) / sky.to_rgb(sky.solar_irradiance());
    const Vec3d depth = depth_of(PlanetAir{}, {{0, 0, 0}, {0, 0, 1}});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::exp(-depth[c]), expected[c], 0.01) << c;
}

TEST(PlanetAir, TransmitsLessAndLessToTheHorizon) {
    Vec3d before;
    for (int degree = 0; degree <= 90; ++degree) {
        const double a = degree * pi / 180;
        const Vec3d depth = depth_of(PlanetAir{}, {{0, 0, 2}, {std::sin(a), 0, std::cos(a)}});
        for (int c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(depth[c]));
            EXPECT_GT(depth[c], before[c]);
        }
        before = depth;
    }
    // Red and dim: 36 times the air, 85 times the haze.
    EXPECT_GT(before.z, 2 * before.x);
}

TEST(PlanetAir, LeavesOutWhatDoesNothing) {
    PlanetAir air;
    EXPECT_EQ(place_media(air, 0, {0, 0, 1}).size(), 3u);
    air.ozone = 0;
    air.mie_scattering = air.mie_absorption = Vec3d(0);
    const auto media = place_media(air, 0, {0, 1, 0});
    ASSERT_EQ(media.size(), 1u);
    EXPECT_TRUE(media[0]->is_bounded());
    EXPECT_NEAR(media[0]->bounds().hi.y, 100e3, 1);
    EXPECT_TRUE(std::holds_alternative<RayleighPhase>(media[0]->phase()));
    EXPECT_EQ(*media[0]->optical_depth({{0, 2e5, 0}, {1, 0, 0}}, 0, never), 0);
}

}  // namespace
}  // namespace gischt
