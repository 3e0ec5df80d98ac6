// SPDX-License-Identifier: Apache-2.0
// Plane-parallel media against published solutions of radiative transfer.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/units.h"
#include "render/photon/photon_views.h"

namespace gischt {
namespace {

using namespace photon_test;

// As for the path tracer: light of 1 W/(m^2 sr) from above in the red channel, from below in the
// green. By reciprocity a camera that looks down sees reflectance and transmittance.
class SkyAndGlow : public Light {
  public:
    LightSample sample(const Vec3d&, Vec2f u) const override {
        const double z = 2 * double(u.x) - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
        const double angle = 2 * pi * double(u.y);
        LightSample s;
        s.direction = {r * std::cos(angle), r * std::sin(angle), z};
        s.pdf = static_cast<float>(1 / (4 * pi));
        s.weight = radiance(s.direction) / Vec3f(s.pdf);
        return s;
    }
    float pdf(const Vec3d&, const Vec3d&) const override {
        return static_cast<float>(1 / (4 * pi));
    }
    Vec3f radiance(const Vec3d& direction) const override {
        return {direction.z > 0 ? 1.0f : 0.0f, direction.z > 0 ? 0.0f : 1.0f, 1.0f};
    }
    bool is_delta() const override { return false; }
    bool is_infinite() const override { return true; }
    Vec3f mean_radiance(const Vec3d&) const override { return {0.5f, 0.5f, 1}; }
};

// A column of a slab of extinction 1/m below z = 0, between mirrors that make it endless. The
// camera sees its middle, from which no photon's ball reaches a mirror.
View slab(double tau, double albedo, double g) {
    View view;
    view.camera = ortho({0, 0, 10}, 0.5);
    view.media = {solid(Region::box({{-0.5, -0.5, -tau}, {0.5, 0.5, 0}}),
                        coefficients(Vec3d(1), Vec3d(albedo), g))};
    view.lights = {std::make_shared<SkyAndGlow>()};
    std::vector<SurfaceParams> walls;
    for (int side = 0; side < 4; ++side) {
        const double sign = side % 2 ? 1 : -1;
        const Vec3d out = side < 2 ? Vec3d(sign, 0, 0) : Vec3d(0, sign, 0);
        BoxSurface wall;
        wall.center = Keyed<Vec3d>(0.55 * out + Vec3d(0, 0, -0.5 * tau));
        wall.size = side < 2 ? Vec3d(0.1, 1.2, tau) : Vec3d(1.2, 0.1, tau);
        wall.material.kind = MaterialKind::Conductor;
        wall.material.color = Vec3d(1);
        walls.push_back(wall);
    }
    view.surfaces = SurfaceSet(walls, 0);
    return view;
}

struct SlabCase {
    double g, albedo, tau, reflectance, transmittance;
};
constexpr SlabCase slabs[] = {
    {0, 0.5, 1, 0.09912, 0.44606},    {0, 0.5, 2, 0.11283, 0.18932},
    {0, 0.9, 1, 0.26741, 0.59163},    {0, 0.9, 2, 0.36165, 0.35650},
    {0, 0.99, 1, 0.33292, 0.65098},   {0, 0.99, 2, 0.49749, 0.46570},
    {0.5, 0.9, 1, 0.12979, 0.73909},  {0.5, 0.9, 2, 0.20451, 0.52327},
    {0.75, 0.9, 1, 0.05595, 0.82792}, {0.75, 0.9, 2, 0.09739, 0.66096},
    {0.75, 1, 1, 0.07878, 0.92122},   {0.75, 1, 2, 0.16322, 0.83678},
    {0.85, 0.9, 1, 0.02968, 0.86215}, {0.85, 0.9, 2, 0.05277, 0.72659},
    {-0.5, 0.9, 1, 0.36729, 0.50185}, {-0.5, 0.9, 2, 0.46277, 0.27607},
    {0, 1, 1, 0.34133, 0.65867},      {0.5, 1, 1, 0.17611, 0.82389},
};

// Beams blur only across the ray, where the slab is even: no radius makes a bias. Points blur along
// the ray too, and lose what their balls reach over the slab's faces: `bias` is allowed for that.
void expect_slabs(const PhotonParams& params, const Effort& effort, double most_error,
                  double bias) {
    const int comparisons = 2 * static_cast<int>(std::size(slabs));
    for (const SlabCase& c : slabs) {
        const std::string name = fmt::format("g {} albedo {} tau {}", c.g, c.albedo, c.tau);
        const Estimate got = mapped_radiance(slab(c.tau, c.albedo, c.g), params, effort);
        expect_mean(got, 0, c.reflectance, comparisons, name + " R", bias + 1e-4);
        expect_mean(got, 1, c.transmittance, comparisons, name + " T", bias + 1e-4);
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
