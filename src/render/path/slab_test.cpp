// SPDX-License-Identifier: Apache-2.0
// Plane-parallel media against published solutions of radiative transfer.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "render/path/test_slabs.h"

namespace gischt {
namespace {

using namespace path_test;

// A slab of extinction 1/m below z = 0, so wide that nothing of its sides arrives in the middle.
View slab(double tau, double albedo, double g) {
    View view;
    view.camera = ortho({0, 0, 10}, 1);
    view.media = {solid(Region::box({{-2000, -2000, -tau}, {2000, 2000, 0}}),
                        coefficients(Vec3d(1), Vec3d(albedo), g))};
    view.lights = {std::make_shared<TwoSkies>()};
    return view;
}

// Forward scattering rarely comes back: for a standard error of 0.2 % it takes more samples.
int batches_of(const SlabCase& c) {
    if (c.g > 0.8) return 34 * 64;
    if (c.g > 0.7) return 14 * 64;
    return c.g > 0.4 ? 5 * 64 : 2 * 64;
}

// With `share` of the samples that such an error takes, and for a method with more noise than the
// common one times as many.
void expect_slabs(const PathParams& params, double share, std::uint64_t seed, double more = 1) {
    for (const SlabCase& c : slabs) {
        const std::string name = fmt::format("g {} albedo {} tau {}", c.g, c.albedo, c.tau);
        const auto samples = static_cast<int>(1024 * share * more);
        const Estimate got =
            mean_radiance(slab(c.tau, c.albedo, c.g), params,
                          {.batches = batches_of(c), .samples = samples, .seed = seed});
        // The tables have five digits.
        expect_mean(got, 0, c.reflectance, slab_comparisons, name + " R", 0.5e-5 / c.reflectance);
        expect_mean(got, 1, c.transmittance, slab_comparisons, name + " T",
                    0.5e-5 / c.transmittance);
        EXPECT_LT(got.error.x, 0.002 * c.reflectance / std::sqrt(share)) << name;
        EXPECT_LT(got.error.y, 0.002 * c.transmittance / std::sqrt(share)) << name;
    }
}

PathParams plain() {
    PathParams params;
    params.camera = CameraSegment::Tracking;
    params.shadow = TransmittanceEstimator::Ratio;
    return params;
}

TEST(PathSlab, ReflectsAndTransmitsWhatTheTablesSay) {
    expect_slabs({}, 1.0 / 16, 1);
}
TEST(PathSlabLong, ReflectsAndTransmitsWhatTheTablesSayWithinAFifthOfAPercent) {
    expect_slabs({}, 1, 2);
}
TEST(PathSlab, PlainTrackingAgreesWithTheTables) {
    expect_slabs(plain(), 1.0 / 16, 3, 2.5);
}
TEST(PathSlabLong, PlainTrackingAgreesWithTheTables) {
    expect_slabs(plain(), 1, 4, 2.5);
}

// Chandrasekhar 1960: 1 - sqrt(1 - a) H(1) is the plane albedo of an isotropic half space at normal
// incidence; a H(1)^2 / 8 is pi times its BRDF straight back.
TEST(PathSlab, HalfSpaceIsThatOfChandrasekhar) {
    for (const auto& [albedo, plane, back] :
         {std::tuple{0.5, 0.115226, 0.097853}, std::tuple{0.9, 0.414947, 0.385072}}) {
        View view = slab(60, albedo, 0);
        const std::string name = fmt::format("albedo {}", albedo);
        const Estimate sky = mean_radiance(view, {}, {.batches = 112, .samples = 1024});
        expect_mean(sky, 0, plane, 4, name, 5e-7 / plane);
        EXPECT_LT(sky.error.x, 0.002 * plane);
        view.lights = {delta_sun({0, 0, 1}, Vec3f(static_cast<float>(pi)))};
        const Estimate sun = mean_radiance(view, {}, {.batches = 128, .samples = 1024});
        expect_mean(sun, 0, back, 4, name + " sun", 5e-7 / back);
        EXPECT_LT(sun.error.x, 0.002 * back);
    }
}

// Giovanelli 1955: a half space of index 1.5 behind a smooth surface, isotropic, albedo 0.9.
TEST(PathSlab, HalfSpaceBehindGlassIsThatOfGiovanelli) {
    BoxSurface box;
    box.center = Keyed<Vec3d>(Vec3d(0, 0, -500));
    box.size = {4000, 4000, 1000};
    box.material.kind = MaterialKind::Dielectric;
    box.material.ior = 1.5;
    box.material.medium = coefficients(Vec3d(1), Vec3d(0.9));
    View view;
    view.camera = ortho({0, 0, 10}, 1);
    view.lights = {std::make_shared<TwoSkies>()};
    view.surfaces = SurfaceSet({box}, 0);
    const Estimate got = mean_radiance(view, {}, {.batches = 256, .samples = 1536});
    expect_mean(got, 0, 0.26, 1, "n 1.5", 0.5e-4 / 0.26);
    EXPECT_LT(got.error.x, 0.002 * 0.26);
}

}  // namespace
}  // namespace gischt
