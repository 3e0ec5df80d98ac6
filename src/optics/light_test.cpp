// SPDX-License-Identifier: Apache-2.0
#include "optics/light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "image/color.h"
#include "math/sobol.h"
#include "optics/blackbody.h"
#include "optics/light_rig.h"
#include "optics/local_lights.h"

namespace gischt {
namespace {

constexpr int count = 1 << 14;

// Mean of weight * f(direction) over stratified samples of a light.
template <class F>
Vec3d estimate(const Light& light, const Vec3d& point, F&& f) {
    Vec3d sum;
    for (int i = 0; i < count; ++i) {
        const LightSample s = light.sample(point, sobol_2d(std::uint32_t(i), 5));
        sum += f(s.direction) * Vec3d(s.weight);
    }
    return sum / double(count);
}

TEST(PointLight, FallsWithTheSquareOfTheDistance) {
    const PointLight light({1, 2, 3}, {10, 20, 40});
    const LightSample s = light.sample({1, 2, 1}, {});
    EXPECT_NEAR(s.distance, 2, 1e-15);
    EXPECT_NEAR(s.direction.z, 1, 1e-15);
    EXPECT_NEAR(s.weight.y, 5, 1e-6);
    EXPECT_EQ(s.pdf, 0);
    EXPECT_NEAR(light.mean_radiance({1, 2, 1}).z, 10 / (4 * pi), 1e-6);
    EXPECT_EQ(light.sample({1, 2, 3}, {}).weight, Vec3f(0));
}

// Flux through a sphere around the spot: the integral of its profile over the cosine.
TEST(SpotLight, ShinesOnlyIntoItsCone) {
    const SpotLight light({0, 0, 0}, {0, 0, -1}, {1, 1, 1}, radians(10), radians(30));
    const auto at = [&](double degrees) {
        const double a = radians(degrees);
        return light.sample({4 * std::sin(a), 0, -4 * std::cos(a)}, {}).weight.x * 16;
    };
    EXPECT_NEAR(at(0), 1, 1e-6);
    EXPECT_NEAR(at(9.9), 1, 1e-6);
    const double cosine = 0.5 * (std::cos(radians(10)) + std::cos(radians(30)));
    EXPECT_NEAR(at(std::acos(cosine) * 180 / pi), 0.5, 1e-6);
    EXPECT_EQ(at(30.1), 0);
    EXPECT_EQ(at(180), 0);
    const SpotLight hard({0, 0, 0}, {0, 0, -1}, {1, 1, 1}, radians(30), radians(30));
    EXPECT_GT(hard.sample({0, 0, -1}, {}).weight.x, 0);
}

TEST(SunLight, DiscHasTheStatedIrradiance) {
    const Vec3d towards = normalize(Vec3d{1, -2, 3});
    for (const double degrees : {0.53, 40.0}) {
        const SunLight sun(towards, {2, 3, 4}, radians(degrees));
        const Vec3d irradiance = estimate(sun, {}, [&](const Vec3d& d) { return dot(d, towards); });
        EXPECT_NEAR(irradiance.y, 3, 3e-4);
        // What is sampled is seen, with the density that pdf() says.
        for (int i = 0; i < 100; ++i) {
            const LightSample s = sun.sample({}, sobol_2d(std::uint32_t(i), 1));
            ASSERT_NEAR(length(s.direction), 1, 1e-12);
            ASSERT_GT(sun.radiance(s.direction).x, 0);
            ASSERT_NEAR(s.weight.x, sun.radiance(s.direction).x / s.pdf, 1e-4);
            ASSERT_EQ(s.pdf, sun.pdf({}, s.direction));
        }
        Vec3d s, t;
        orthonormal_frame(towards, s, t);
        const double outside = radians(0.51 * degrees);
        EXPECT_EQ(sun.radiance(std::cos(outside) * towards + std::sin(outside) * s).x, 0);
        const Vec3d fluence = estimate(sun, {}, [](const Vec3d&) { return 1.0; });
        EXPECT_NEAR(fluence.x, 4 * pi * sun.mean_radiance({}).x, 1e-3);
    }
    const SunLight point(towards, {2, 3, 4}, 0);
    EXPECT_TRUE(point.is_delta());
    EXPECT_EQ(point.sample({}, {}).weight, Vec3f(2, 3, 4));
    EXPECT_EQ(point.radiance(towards), Vec3f(0));
}

TEST(ConstantLight, FillsTheSphere) {
    const ConstantLight light({1, 2, 3});
    EXPECT_NEAR(estimate(light, {}, [](const Vec3d&) { return 1.0; }).y, 8 * pi, 1e-4);
    const Vec3d up = estimate(light, {}, [](const Vec3d& d) { return std::max(0.0, d.z); });
    EXPECT_NEAR(up.x, pi, 2e-3);
}

TEST(LightRig, MakesTheLightsOfAMoment) {
    PointParams lamp;
    lamp.name = "lamp";
    lamp.intensity = Keyed<double>({0, 1}, {0, 8});
    lamp.temperature = Keyed<double>(2856);
    SunParams sun;
    sun.azimuth_degrees = Keyed<double>(90);
    sun.elevation_degrees = Keyed<double>(0);
    LightRig rig({lamp, sun}, {0, 1, 0}, {});
    EXPECT_EQ(rig.at(0).size(), 1u);
    const auto lights = rig.at(1);
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0]->name, "lamp");
    const LightSample s = lights[0]->sample({0, 0, 4}, {});
    EXPECT_NEAR(luminance(s.weight), 8, 1e-4);
    EXPECT_NEAR(s.weight.x / s.weight.z, blackbody_color(2856).x / blackbody_color(2856).z, 1e-4);
    EXPECT_NEAR(lights[1]->sample({}, {}).direction.x, 1, 1e-4);
    EXPECT_EQ(infinite_radiance(lights, {1, 0, 0}, true), Vec3f(0));
    EXPECT_GT(infinite_radiance(lights, {1, 0, 0}, false).x, 0);

    EnvironmentParams picture;
    picture.file = "x.hdr";
    EXPECT_THROW(LightRig({picture}, {0, 0, 1}, {}), Error);
}

TEST(LightRig, ReadsFromTables) {
    Value table;
    table.set("type", "sun");
    table.set("irradiance", 5);
    table.set("azimuth_degrees", 20);
    const auto sun = std::get<SunParams>(read(table, light_variants()));
    EXPECT_EQ(sun.irradiance.at(0), 5);
    table.set("intensity", 5);
    EXPECT_THROW(read(table, light_variants()), Error);
}

// A grey card under the sun alone: half of its fluence is the card's irradiance.
TEST(LightRig, NaturalExposureShowsGreyAsGrey) {
    const std::vector<LightPtr> lights{std::make_shared<ConstantLight>(Vec3f(7))};
    const double card = 0.18 * 7;
    EXPECT_NEAR(card * std::exp2(natural_exposure(lights, {})), 0.09, 1e-6);
    EXPECT_EQ(natural_exposure({}, {}), 0);
}

}  // namespace
}  // namespace gischt
