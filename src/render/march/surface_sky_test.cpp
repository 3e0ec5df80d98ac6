// SPDX-License-Identifier: Apache-2.0
// The light of the sky on surfaces.
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "math/sobol.h"
#include "optics/environment.h"
#include "optics/surface_params.h"
#include "render/march/aimed_sky.h"
#include "render/march/irradiance_map.h"
#include "render/march/march.h"
#include "render/march/ray_march.h"

namespace gischt {
namespace {

// Radiance 2 + z with z up, or with a hot spot beside.
EnvironmentMap::Ptr gradient(double hot) {
    return std::make_shared<const EnvironmentMap>(256, 128, [=](const Vec3d& d) {
        const double spot = std::exp(400 * (dot(d, normalize(Vec3d(1, 2, 1))) - 1));
        return Vec3f(Vec3d(2 + d.z + hot * spot));
    });
}

// Integral of (2 + z) max(0, cosine).
double irradiance_of_gradient(const Vec3d& normal) {
    return 2 * pi + 2 * pi / 3 * normal.z;
}

const Vec3d normals[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6, 0, 0.8}, {-0.36, 0.48, -0.8}};

TEST(IrradianceMap, AgreesWithClosedForms) {
    const IrradianceMap even(ConstantLight(Vec3f(1, 2, 3)));
    const IrradianceMap map(EnvironmentLight(gradient(0), {}, Vec3f(1)));
    for (const Vec3d& n : normals) {
        EXPECT_NEAR(even(n).z, 3 * pi, 3 * pi * 2e-3);
        EXPECT_NEAR(map(n).y, irradiance_of_gradient(n), 2e-3 * 2.7 * pi);
    }
}

TEST(AimedSky, DrawsWithTheRightWeights) {
    for (const double hot : {0.0, 100.0}) {
        const EnvironmentLight light(gradient(hot), {}, Vec3f(1));
        // Around a spot of exp(-k (1 - cos)) lie 2 pi / k.
        const double spot = hot * 2 * pi / 400;
        AimedSky sky(light);
        for (const Vec3d& n : normals) {
            sky.aim(n);
            double sum = 0, squares = 0;
            constexpr int count = 4096;
            for (std::uint32_t i = 0; i < count; ++i) {
                const auto w = static_cast<double>(sky(sobol_2d(i, 3)).weight.y);
                sum += w / count;
                squares += w * w / count;
            }
            const double expected =
                irradiance_of_gradient(n) + spot * std::max(0.0, dot(n, normalize(Vec3d(1, 2, 1))));
            EXPECT_NEAR(sum / expected, 1, 6e-3) << n.x << " " << n.y << " " << n.z;
            // In proportion to radiance times cosine: hardly any spread is left.
            EXPECT_LT(std::sqrt(squares / (sum * sum) - 1), 0.3) << n.x << " " << n.y << " " << n.z;
        }
    }
}

View floor_under(LightPtr light, std::vector<SurfaceParams> surfaces = {}) {
    GroundSurface ground;
    ground.material.albedo = Vec3d(0.5);
    surfaces.emplace_back(ground);
    View view;
    view.surfaces = SurfaceSet(surfaces, 0);
    view.lights = {std::move(light)};
    return view;
}

struct Spread {
    double mean = 0, deviation = 0;
};

// Of the radiance that single samples see at a point of the floor.
Spread look_at_floor(const View& view, const Vec3d& point, int samples) {
    Job job;
    const MarchParams params;
    const MarchScene scene(view, params, job);
    RayMarcher marcher(scene);
    const Ray ray{point + Vec3d(0, 0, 0.1), {0, 0, -1}};
    Spread s;
    double squares = 0;
    for (int i = 0; i < samples; ++i) {
        // Another pixel each: independent samples.
        const PixelSampler numbers(9, 1, 37 * i % 4096, 61 * i % 4096, 0);
        const auto value = static_cast<double>(marcher(ray, numbers).radiance.y);
        s.mean += value / samples;
        squares += value * value / samples;
    }
    s.deviation = std::sqrt(std::max(0.0, squares - s.mean * s.mean));
    return s;
}

TEST(SurfaceSky, IsFreeOfNoiseUnderAnOpenSky) {
    const auto light = std::make_shared<EnvironmentLight>(gradient(100), Transform{}, Vec3f(1));
    const Spread s = look_at_floor(floor_under(light), {}, 64);
    const double expected = 0.5 / pi * (2 * pi + 2 * pi / 3 + 100 * 2 * pi / 400 / std::sqrt(6.0));
    EXPECT_NEAR(s.mean / expected, 1, 3e-3);
    EXPECT_LT(s.deviation, 1e-5 * s.mean);
}

// The edges of still surfaces and their light are the same in every frame: nothing flickers.
TEST(SurfaceSky, StaysStillFromFrameToFrame) {
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(0, 0, 9));
    View view =
        floor_under(std::make_shared<EnvironmentLight>(gradient(0), Transform{}, Vec3f(1)), {ball});
    CameraParams camera;
    camera.position = Keyed<Vec3d>(Vec3d(0, -30, 5));
    camera.target = Keyed<Vec3d>(Vec3d(0, 0, 5));
    view.camera = Camera(camera, 0, 32, 32);
    RenderSettings settings;
    settings.samples_per_pixel = 2;
    Job job;
    view.frame = 1;
    const Image one = make_march_method({})->render(view, settings, job).image;
    view.frame = 2;
    const Image two = make_march_method({})->render(view, settings, job).image;
    const auto a = one.channel("G"), b = two.channel("G");
    for (int x = 0; x < 32; ++x) {
        // The horizon is in the middle, the ball's top above it; its foot's shadow is not looked
        // at.
        for (const int y : {2, 8, 12, 15, 16}) {
            const std::size_t i = one.index(x, y);
            EXPECT_NEAR(a[i], b[i], 0.02f * a[i]) << x << " " << y;
        }
    }
}

// At the foot of an endless wall whose top stands at an elevation a, (1 + cos a) / 2 of the
// irradiance of an even sky arrives.
TEST(SurfaceSky, IsUnbiasedBesideAWall) {
    for (const double elevation : {0.3, 0.9, 1.4}) {
        BoxSurface wall;
        wall.center = Keyed<Vec3d>(Vec3d(1.5, 0, 0));
        wall.size = {1, 1e5, 2 * std::tan(elevation)};
        const View view = floor_under(std::make_shared<ConstantLight>(Vec3f(1)), {wall});
        constexpr int samples = 20000;
        const Spread s = look_at_floor(view, {}, samples);
        // 4 standard errors: one in 16000 such tests fails by chance, if the seed changes. The
        // table of irradiance is right to 1e-3.
        EXPECT_NEAR(s.mean, 0.5 * 0.5 * (1 + std::cos(elevation)),
                    4 * s.deviation / std::sqrt(samples) + 5e-4)
            << elevation;
        EXPECT_GT(s.deviation, 0);
    }
}

}  // namespace
}  // namespace gischt
