// SPDX-License-Identifier: Apache-2.0
#include "optics/local_lights.h"

#include "base/units.h"
#include "math/interpolate.h"

namespace gischt {
namespace {

// The sample of a point-like light; its weight is intensity over distance squared. At the light
// itself there is no direction and no light.
LightSample towards_point(const Vec3d& from, const Vec3d& light, const Vec3f& intensity) {
    const Vec3d d = light - from;
    const double r2 = dot(d, d);
    if (!(r2 > 0)) return {{0, 0, 1}, 0, {}, 0};
    const double r = std::sqrt(r2);
    return {d / r, r, intensity * static_cast<float>(1 / r2), 0};
}

Vec3f over_sphere(const LightSample& sample) {
    return sample.weight * static_cast<float>(0.25 / pi);
}

}  // namespace

LightSample PointLight::sample(const Vec3d& point, Vec2f) const {
    return towards_point(point, position_, intensity_);
}

Vec3f PointLight::mean_radiance(const Vec3d& point) const {
    return over_sphere(sample(point, {}));
}

SpotLight::SpotLight(const Vec3d& position, const Vec3d& axis, const Vec3f& intensity, double inner,
                     double outer)
    : position_(position),
      axis_(axis),
      intensity_(intensity),
      cos_inner_(std::cos(inner)),
      cos_outer_(std::cos(outer)) {}

LightSample SpotLight::sample(const Vec3d& point, Vec2f) const {
    LightSample sample = towards_point(point, position_, intensity_);
    sample.weight *= static_cast<float>(share(-dot(sample.direction, axis_)));
    return sample;
}

double SpotLight::share(double cosine) const {
    const double width = cos_inner_ - cos_outer_;
    return width > 0 ? smoothstep((cosine - cos_outer_) / width)
                     : (cosine >= cos_outer_ ? 1.0 : 0.0);
}

// The integral of the smoothstep over the rim is x^3 (2 - x) / 2, inverted by halving.
Vec3d SpotLight::direction(Vec2f u) const {
    const double inner = 1 - cos_inner_, width = cos_inner_ - cos_outer_;
    const double at = static_cast<double>(u.x) * (inner + 0.5 * width);
    double cosine = 1 - at;
    if (at > inner) {
        const double inwards = 1 - (at - inner) / (0.5 * width);
        double low = 0, high = 1;
        for (int i = 0; i < 40; ++i) {
            const double x = 0.5 * (low + high);
            (x * x * x * (2 - x) < inwards ? low : high) = x;
        }
        cosine = cos_outer_ + 0.5 * (low + high) * width;
    }
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)),
                 turn = 2 * pi * static_cast<double>(u.y);
    Vec3d s, t;
    orthonormal_frame(axis_, s, t);
    return cosine * axis_ + sine * (std::cos(turn) * s + std::sin(turn) * t);
}

Vec3f SpotLight::mean_radiance(const Vec3d& point) const {
    return over_sphere(sample(point, {}));
}

SunLight::SunLight(const Vec3d& towards, const Vec3f& irradiance, double angular_diameter)
    : towards_(towards), irradiance_(irradiance) {
    orthonormal_frame(towards_, s_, t_);
    const double half_sine = std::sin(0.25 * angular_diameter);
    one_minus_cos_ = 2 * half_sine * half_sine;
    solid_angle_ = 2 * pi * one_minus_cos_;
    // The cosine-weighted solid angle of the disc is pi sin^2 of its angular radius.
    const double sine = std::sin(0.5 * angular_diameter);
    if (solid_angle_ > 0) radiance_ = irradiance_ * static_cast<float>(1 / (pi * sine * sine));
}

LightSample SunLight::sample(const Vec3d&, Vec2f u) const {
    LightSample sample;
    if (is_delta()) {
        sample.direction = towards_;
        sample.weight = irradiance_;
        return sample;
    }
    const double drop = static_cast<double>(u.x) * one_minus_cos_;
    const double sine = std::sqrt(drop * (2 - drop)), turn = 2 * pi * static_cast<double>(u.y);
    sample.direction = (1 - drop) * towards_ + sine * (std::cos(turn) * s_ + std::sin(turn) * t_);
    sample.weight = radiance_ * static_cast<float>(solid_angle_);
    sample.pdf = static_cast<float>(1 / solid_angle_);
    return sample;
}

bool SunLight::is_inside(const Vec3d& direction) const {
    // |direction - towards|^2 = 2 (1 - cos).
    const Vec3d d = direction - towards_;
    return dot(d, d) <= 2 * one_minus_cos_;
}

float SunLight::pdf(const Vec3d&, const Vec3d& direction) const {
    return !is_delta() && is_inside(direction) ? static_cast<float>(1 / solid_angle_) : 0;
}

Vec3f SunLight::radiance(const Vec3d& direction) const {
    return !is_delta() && is_inside(direction) ? radiance_ : Vec3f(0);
}

Vec3f SunLight::mean_radiance(const Vec3d&) const {
    const double weight = is_delta() ? 0.25 / pi : solid_angle_ * 0.25 / pi;
    return (is_delta() ? irradiance_ : radiance_) * static_cast<float>(weight);
}

}  // namespace gischt
