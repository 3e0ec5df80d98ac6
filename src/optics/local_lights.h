// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/units.h"
#include "optics/light.h"

namespace gischt {

// A point that shines equally in all directions; irradiance falls with the square of the distance.
class PointLight : public Light {
  public:
    // Metres; W/sr.
    PointLight(const Vec3d& position, const Vec3f& intensity)
        : position_(position), intensity_(intensity) {}

    LightSample sample(const Vec3d& point, Vec2f u) const override;
    float pdf(const Vec3d&, const Vec3d&) const override { return 0; }
    Vec3f radiance(const Vec3d&) const override { return {}; }
    bool is_delta() const override { return true; }
    bool is_infinite() const override { return false; }
    Vec3f mean_radiance(const Vec3d& point) const override;
    std::optional<LightPlace> place() const override { return LightPlace{position_, 0}; }

  private:
    Vec3d position_;
    Vec3f intensity_;
};

// A point that shines into a cone around an axis: full intensity inside the inner cone, none
// outside of the outer, smoothstep in the cosine between.
class SpotLight : public Light {
  public:
    // Half angles in radians, 0 <= inner <= outer <= pi; axis is a unit vector away from the light.
    SpotLight(const Vec3d& position, const Vec3d& axis, const Vec3f& intensity, double inner,
              double outer);

    const Vec3d& axis() const { return axis_; }
    // The share of the full intensity at a cosine from the axis, its integral over all directions
    // (sr), and directions drawn in proportion to it.
    double share(double cosine) const;
    double solid_angle() const { return 2 * pi * (1 - 0.5 * (cos_inner_ + cos_outer_)); }
    Vec3d direction(Vec2f u) const;

    LightSample sample(const Vec3d& point, Vec2f u) const override;
    float pdf(const Vec3d&, const Vec3d&) const override { return 0; }
    Vec3f radiance(const Vec3d&) const override { return {}; }
    bool is_delta() const override { return true; }
    bool is_infinite() const override { return false; }
    Vec3f mean_radiance(const Vec3d& point) const override;
    std::optional<LightPlace> place() const override { return LightPlace{position_, 0}; }

  private:
    Vec3d position_, axis_;
    Vec3f intensity_;
    double cos_inner_, cos_outer_;
};

// Light from one far direction: the sun. A disc of even radiance, or a delta light where its
// angular diameter is 0.
class SunLight : public Light {
  public:
    // `towards`: unit vector to the sun; irradiance on a plane that faces it, W/m^2; angular
    // diameter in radians, below pi.
    SunLight(const Vec3d& towards, const Vec3f& irradiance, double angular_diameter);

    const Vec3d& direction() const { return towards_; }

    LightSample sample(const Vec3d& point, Vec2f u) const override;
    float pdf(const Vec3d& point, const Vec3d& direction) const override;
    Vec3f radiance(const Vec3d& direction) const override;
    bool is_delta() const override { return solid_angle_ == 0; }
    bool is_infinite() const override { return true; }
    Vec3f mean_radiance(const Vec3d& point) const override;

  private:
    bool is_inside(const Vec3d& direction) const;

    Vec3d towards_, s_, t_;
    Vec3f irradiance_, radiance_;
    // 1 - cos of the angular radius, which alone keeps its digits for a small disc.
    double one_minus_cos_, solid_angle_;
};

}  // namespace gischt
