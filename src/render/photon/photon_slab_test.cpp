// SPDX-License-Identifier: Apache-2.0
// Plane-parallel media against published solutions of radiative transfer.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "render/path/test_slabs.h"
#include "render/photon/photon_views.h"

namespace gischt {
namespace {

using namespace photon_test;

// Beams blur only across the ray, where the slab is even: no radius makes a bias. Points blur along
// the ray too, and lose what their balls reach over the slab's faces: `bias` is allowed for that.
void expect_slabs(const PhotonParams& params, const Effort& effort, double most_error,
                  double bias) {
    for (const SlabCase& c : slabs) {
        const std::string name = fmt::format("g {} albedo {} tau {}", c.g, c.albedo, c.tau);
        const Estimate got = mapped_radiance(mirrored_slab(c.tau, c.albedo, c.g), params, effort);
        expect_mean(got, 0, c.reflectance, slab_comparisons, name + " R", bias + 1e-4);
        expect_mean(got, 1, c.transmittance, slab_comparisons, name + " T", bias + 1e-4);
        EXPECT_LT(got.error.x, most_error * c.reflectance) << name;
        EXPECT_LT(got.error.y, most_error * c.transmittance) << name;
    }
}

PhotonParams few_photons() {
    PhotonParams params;
    params.photons = 3000;
    params.nearest = 10;
    return params;
}

TEST(PhotonSlab, ReflectsAndTransmitsWhatTheTablesSay) {
    expect_slabs(few_photons(), {.batches = 16, .samples = 64, .seed = 1}, 0.15, 0);
}
TEST(PhotonSlabLong, ReflectsAndTransmitsWhatTheTablesSay) {
    PhotonParams params = few_photons();
    params.photons = 20'000;
    expect_slabs(params, {.batches = 48, .samples = 256, .seed = 2}, 0.04, 0);
}
TEST(PhotonSlabLong, PointsAgreeWithTheTables) {
    PhotonParams params = few_photons();
    params.gather = PhotonGather::Points;
    params.photons = 100'000;
    expect_slabs(params, {.batches = 16, .samples = 128, .seed = 3}, 0.1, 0.03);
}

}  // namespace
}  // namespace gischt
