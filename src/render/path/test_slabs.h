// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/units.h"
#include "render/path/test_views.h"

// Plane-parallel media whose solutions are published.
namespace gischt::path_test {

// Light of 1 W/(m^2 sr) from above (z > 0) in the red, from below in the green, from everywhere in
// the blue channel. By reciprocity a camera that looks down at a slab sees its reflectance for
// normal incidence in red, its transmittance in green, and in blue their sum.
class TwoSkies : public Light {
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

// Henyey-Greenstein slabs with matched index and black surroundings: van de Hulst 1980 and discrete
// ordinates with 64 streams, which agree with each other to every digit.
struct SlabCase {
    double g, albedo, tau, reflectance, transmittance;
};
inline constexpr SlabCase slabs[] = {
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
inline constexpr int slab_comparisons = 2 * static_cast<int>(std::size(slabs));

// A column of a slab of extinction 1/m below z = 0, between mirrors that make it endless, for
// methods that cannot do with a slab that is merely wide; seen from above in its middle.
inline View mirrored_slab(double tau, double albedo, double g) {
    View view;
    view.camera = ortho({0, 0, 10}, 0.5);
    view.media = {solid(Region::box({{-0.5, -0.5, -tau}, {0.5, 0.5, 0}}),
                        coefficients(Vec3d(1), Vec3d(albedo), g))};
    view.lights = {std::make_shared<TwoSkies>()};
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

}  // namespace gischt::path_test
