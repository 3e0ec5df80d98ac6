// SPDX-License-Identifier: Apache-2.0
#include "orbit.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace gischt {

Orbit::Orbit(const CameraParams& params, double time, const Vec3d& up) : params_(params), up_(up) {
    const Vec3d other = std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    east_ = normalize(other - dot(other, up) * up);
    north_ = cross(up, east_);
    target_ = params.target.at(time);
    const Vec3d way = params.position.at(time) - target_;
    distance_ = length(way);
    elevation_ = std::asin(std::clamp(dot(way, up_) / distance_, -1.0, 1.0));
    azimuth_ = std::atan2(dot(way, north_), dot(way, east_));
    height_ = params.projection == Projection::Orthographic
                  ? params.height.at(time)
                  : 2 * distance_ * std::tan(0.5 * params.fov_degrees.at(time) * pi / 180);
    turn(0, 0);
}

Vec3d Orbit::outwards() const {
    return std::cos(elevation_) * (std::cos(azimuth_) * east_ + std::sin(azimuth_) * north_) +
           std::sin(elevation_) * up_;
}

Vec3d Orbit::position() const {
    return target_ + distance_ * outwards();
}

void Orbit::turn(double right, double upwards) {
    constexpr double limit = 0.5 * pi - 0.01;
    azimuth_ = std::remainder(azimuth_ + right, 2 * pi);
    elevation_ = std::clamp(elevation_ + upwards, -limit, limit);
}

void Orbit::pan(double right, double upwards) {
    const Vec3d forward = -outwards(), side = normalize(cross(forward, up_));
    target_ += height_ * (right * side + upwards * cross(side, forward));
}

void Orbit::dolly(double factor) {
    const double before = distance_;
    distance_ = std::clamp(distance_ * factor, 1e-6, 1e12);
    height_ *= distance_ / before;
    if (params_.projection == Projection::Orthographic) params_.height = height_;
}

CameraParams Orbit::params() const {
    CameraParams params = params_;
    params.position = position();
    params.target = target_;
    return params;
}

Vec3d Orbit::point_at(const Camera& camera, Vec2d pixel, const Vec3d& target) {
    const Ray ray = camera.ray(pixel.x, pixel.y);
    const double depth = dot(target - ray.origin, camera.forward());
    return ray.at(depth / dot(ray.direction, camera.forward()));
}

}  // namespace gischt
