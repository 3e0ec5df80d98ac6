// SPDX-License-Identifier: Apache-2.0
#include "optics/camera.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "optics/orientation.h"

namespace gischt {

const Table<CameraParams>& camera_table() {
    static const Table<CameraParams> table =
        Table<CameraParams>("camera", "From where the picture is taken")
            .choice("type", &CameraParams::projection,
                    {{"perspective", Projection::Perspective, "a pinhole"},
                     {"orthographic", Projection::Orthographic, "parallel rays"}},
                    {.help = "The projection"})
            .add("position", &CameraParams::position, {.unit = "m", .help = "The eye"})
            .add("target", &CameraParams::target,
                 {.unit = "m", .help = "The point that appears in the middle"})
            .add("up", &CameraParams::up,
                 {.help = "What is up in the picture; the scene's up axis when not given"})
            .add("fov_degrees", &CameraParams::fov_degrees,
                 {.unit = "degrees",
                  .help = "Full vertical field of view, perspective only",
                  .min = 0,
                  .max = 180,
                  .min_open = true,
                  .max_open = true})
            .add("height", &CameraParams::height,
                 {.unit = "m",
                  .help = "Full height of the picture, orthographic only",
                  .min = 0,
                  .min_open = true})
            .add("roll_degrees", &CameraParams::roll_degrees,
                 {.unit = "degrees",
                  .help = "Turns the camera around its axis; the content of the picture turns the "
                          "other way"});
    return table;
}

Camera::Camera(const CameraParams& params, double time, int width, int height,
               const Vec3d& scene_up)
    : projection_(params.projection),
      position_(params.position.at(time)),
      width_(width),
      height_(height) {
    if (width < 1 || height < 1) {
        throw Error(ErrorKind::Usage, "camera", "the picture has no pixels");
    }
    const Vec3d towards = params.target.at(time) - position_;
    if (!(length(towards) > 0)) {
        throw Error(ErrorKind::Usage, "camera", "position and target are the same point",
                    "move one of them");
    }
    forward_ = normalize(towards);
    const Vec3d up = normalize(params.up ? params.up->at(time) : scene_up);
    const Vec3d side = cross(forward_, up);
    if (length(side) > 1e-9) {
        right_ = normalize(side);
        up_ = cross(right_, forward_);
    } else {
        orthonormal_frame(-forward_, right_, up_);
    }
    const double roll = radians(params.roll_degrees.at(time));
    const Vec3d right = right_, above = up_;
    right_ = std::cos(roll) * right - std::sin(roll) * above;
    up_ = std::sin(roll) * right + std::cos(roll) * above;
    scale_ = projection_ == Projection::Perspective
                 ? std::tan(radians(0.5 * params.fov_degrees.at(time)))
                 : 0.5 * params.height.at(time);
}

Ray Camera::ray(double x, double y, Vec2f, double) const {
    const double to_plane = 2 * scale_ / height_;
    const Vec3d offset =
        (x - 0.5 * width_) * to_plane * right_ + (0.5 * height_ - y) * to_plane * up_;
    Ray ray;
    if (projection_ == Projection::Perspective) {
        ray.origin = position_;
        ray.direction = normalize(forward_ + offset);
    } else {
        ray.origin = position_ + offset;
        ray.direction = forward_;
    }
    return ray;
}

std::optional<Vec2d> Camera::project(const Vec3d& point) const {
    const Vec3d d = point - position_;
    double scale = 0.5 * height_ / scale_;
    if (projection_ == Projection::Perspective) {
        const double depth = dot(d, forward_);
        if (!(depth > 0)) return std::nullopt;
        scale /= depth;
    }
    return Vec2d{0.5 * width_ + scale * dot(d, right_), 0.5 * height_ - scale * dot(d, up_)};
}

double Camera::pixel_size(double depth) const {
    const double size = 2 * scale_ / height_;
    return projection_ == Projection::Perspective ? size * depth : size;
}

CameraParams fit_camera(const Box3d& box, const Framing& framing) {
    const Vec3d center = 0.5 * (box.lo + box.hi), half = 0.5 * box.size();
    if (!(min_component(half) >= 0) || !(max_component(half) > 0) ||
        !std::isfinite(dot(half, half) + dot(center, center))) {
        throw Error(ErrorKind::Usage, "camera", "there is nothing to frame: the bounds are empty",
                    "set camera.position and camera.target");
    }
    const Vec3d forward =
        -horizon_direction(framing.azimuth_degrees, framing.elevation_degrees, framing.up);
    Vec3d right = cross(forward, framing.up), up;
    if (length(right) > 1e-9) {
        right = normalize(right);
        up = cross(right, forward);
    } else {
        orthonormal_frame(-forward, right, up);
    }

    // A corner at (x, depth z) is inside the picture of a camera at (cx, cz) when
    // |x - cx| <= t (z - cz), that is t cz - cx <= t z - x and t cz + cx <= t z + x. The tightest
    // values of both sides give the camera that is as near as possible; the nearer of the two
    // axes gives way to the other.
    const double t_up = std::tan(radians(0.5 * framing.fov_degrees)) * (1 - 2 * framing.margin);
    const double t_right = t_up * framing.aspect;
    double low[2], high[2];
    for (int a = 0; a < 2; ++a) low[a] = high[a] = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                      corner & 4 ? half.z : -half.z};
        const double z = dot(p, forward), x[2] = {dot(p, right), dot(p, up)};
        const double t[2] = {t_right, t_up};
        for (int a = 0; a < 2; ++a) {
            low[a] = std::min(low[a], t[a] * z - x[a]);
            high[a] = std::min(high[a], t[a] * z + x[a]);
        }
    }
    const double cz = std::min((low[0] + high[0]) / (2 * t_right), (low[1] + high[1]) / (2 * t_up));
    const double cx = 0.5 * (high[0] - low[0]), cy = 0.5 * (high[1] - low[1]);

    CameraParams params;
    params.position = Keyed<Vec3d>(center + cx * right + cy * up + cz * forward);
    params.target = Keyed<Vec3d>(center + cx * right + cy * up);
    params.up = Keyed<Vec3d>(framing.up);
    params.fov_degrees = Keyed<double>(framing.fov_degrees);
    return params;
}

}  // namespace gischt
