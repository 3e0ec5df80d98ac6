// SPDX-License-Identifier: Apache-2.0
#include "optics/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "math/interpolate.h"
#include "optics/aperture.h"
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
                          "other way"})
            .add("lens_radius", &CameraParams::lens_radius,
                 {.unit = "m",
                  .help = "Radius of the lens: what is out of focus is blurred; 0 is a pinhole",
                  .min = 0})
            .add("f_number", &CameraParams::f_number,
                 {.help = "In place of lens_radius: focal length / diameter of the lens, the focal "
                          "length being that of sensor_height and fov_degrees; 0 is a pinhole",
                  .min = 0})
            .add("sensor_height", &CameraParams::sensor_height,
                 {.unit = "m",
                  .help = "Height of the sensor behind f_number; 0.024 is that of 35 mm film",
                  .min = 0,
                  .min_open = true})
            .add("focus_distance", &CameraParams::focus_distance,
                 {.unit = "m",
                  .help = "Depth of what is sharp; the target's when not given",
                  .min = 0,
                  .min_open = true})
            .add("focus_target", &CameraParams::focus_target,
                 {.unit = "m", .help = "In place of focus_distance: a point that is sharp"})
            .add("blades", &CameraParams::blades,
                 {.help = "Corners of the aperture, seen in blurred lights; below 3 it is round",
                  .min = 0,
                  .max = 64})
            .add("blade_rotation_degrees", &CameraParams::blade_rotation_degrees,
                 {.unit = "degrees", .help = "Turns the aperture"});
    return table;
}

static bool is_at_rest(const CameraParams& p) {
    return p.position.is_constant() && p.target.is_constant() && (!p.up || p.up->is_constant()) &&
           p.fov_degrees.is_constant() && p.height.is_constant() && p.roll_degrees.is_constant() &&
           p.lens_radius.is_constant() && p.f_number.is_constant() &&
           (!p.focus_distance || p.focus_distance->is_constant()) &&
           (!p.focus_target || p.focus_target->is_constant());
}

Camera::Camera(const CameraParams& params, double time, int width, int height,
               const Vec3d& scene_up, double shutter)
    : projection_(params.projection),
      middle_(pose_at(params, time, scene_up)),
      blades_(params.blades),
      blade_rotation_(radians(params.blade_rotation_degrees)),
      width_(width),
      height_(height) {
    if (width < 1 || height < 1) {
        throw Error(ErrorKind::Usage, "camera", "the picture has no pixels");
    }
    if (!(shutter > 0) || is_at_rest(params)) return;
    // Straight from moment to moment: a turn of 90 degrees while the shutter is open is followed
    // to a thousandth of the way between two of them.
    constexpr int moments = 33;
    for (int i = 0; i < moments; ++i) {
        const double share = static_cast<double>(i) / (moments - 1) - 0.5;
        moving_.push_back(pose_at(params, time + share * shutter, scene_up));
    }
}

Camera::Pose Camera::pose_at(const CameraParams& params, double time, const Vec3d& scene_up) {
    Pose pose;
    pose.position = params.position.at(time);
    const Vec3d towards = params.target.at(time) - pose.position;
    if (!(length(towards) > 0)) {
        throw Error(ErrorKind::Usage, "camera", "position and target are the same point",
                    "move one of them");
    }
    pose.forward = normalize(towards);
    const Vec3d up = normalize(params.up ? params.up->at(time) : scene_up);
    const Vec3d side = cross(pose.forward, up);
    Vec3d right, above;
    if (length(side) > 1e-9) {
        right = normalize(side);
        above = cross(right, pose.forward);
    } else {
        orthonormal_frame(-pose.forward, right, above);
    }
    const double roll = radians(params.roll_degrees.at(time));
    pose.right = std::cos(roll) * right - std::sin(roll) * above;
    pose.up = std::sin(roll) * right + std::cos(roll) * above;
    const bool perspective = params.projection == Projection::Perspective;
    pose.scale = perspective ? std::tan(radians(0.5 * params.fov_degrees.at(time)))
                             : 0.5 * params.height.at(time);

    const double number = params.f_number.at(time);
    pose.lens_radius = params.lens_radius.at(time);
    if (number > 0 && (pose.lens_radius > 0 || !perspective)) {
        throw Error(ErrorKind::Usage, "camera",
                    perspective ? "f_number and lens_radius both say how wide the lens is"
                                : "an orthographic camera has no focal length",
                    perspective ? "leave one of them out" : "take lens_radius");
    }
    if (number > 0) pose.lens_radius = 0.25 * params.sensor_height / pose.scale / number;
    if (params.focus_distance && params.focus_target) {
        throw Error(ErrorKind::Usage, "camera",
                    "focus_distance and focus_target both say the focus", "leave one of them out");
    }
    pose.focus_distance = params.focus_distance ? params.focus_distance->at(time)
                          : params.focus_target
                              ? dot(params.focus_target->at(time) - pose.position, pose.forward)
                              : length(towards);
    if (pose.lens_radius > 0 && !(pose.focus_distance > 0)) {
        throw Error(ErrorKind::Usage, "camera", "the focus lies behind the camera",
                    "choose another focus_target");
    }
    return pose;
}

Camera::Pose Camera::pose(double time) const {
    if (moving_.empty()) return middle_;
    const double at = std::clamp(time, 0.0, 1.0) * static_cast<double>(moving_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), moving_.size() - 2);
    const double s = at - static_cast<double>(i);
    const Pose &a = moving_[i], &b = moving_[i + 1];
    Pose p;
    p.position = lerp(a.position, b.position, s);
    p.forward = normalize(lerp(a.forward, b.forward, s));
    p.right = lerp(a.right, b.right, s);
    p.right = normalize(p.right - dot(p.right, p.forward) * p.forward);
    p.up = cross(p.right, p.forward);
    p.scale = lerp(a.scale, b.scale, s);
    p.lens_radius = lerp(a.lens_radius, b.lens_radius, s);
    p.focus_distance = lerp(a.focus_distance, b.focus_distance, s);
    return p;
}

Ray Camera::ray(double x, double y, Vec2f lens, double time) const {
    const Pose p = pose(time);
    const double to_plane = 2 * p.scale / height_;
    const Vec3d offset =
        (x - 0.5 * width_) * to_plane * p.right + (0.5 * height_ - y) * to_plane * p.up;
    // Through the middle of the lens, `toward` being one metre deep.
    const bool perspective = projection_ == Projection::Perspective;
    Ray ray;
    ray.origin = perspective ? p.position : p.position + offset;
    const Vec3d toward = perspective ? p.forward + offset : p.forward;
    ray.direction = normalize(toward);
    if (!(p.lens_radius > 0)) return ray;
    // Every point of the lens sees the point of the focus plane that its middle sees.
    const Vec3d focus = ray.origin + p.focus_distance * toward;
    const Vec2d at = aperture_point(lens, blades_, blade_rotation_);
    ray.origin += p.lens_radius * (at.x * p.right + at.y * p.up);
    ray.direction = normalize(focus - ray.origin);
    return ray;
}

std::optional<Vec2d> Camera::project(const Vec3d& point) const {
    const Vec3d d = point - middle_.position;
    double scale = 0.5 * height_ / middle_.scale;
    if (projection_ == Projection::Perspective) {
        const double depth = dot(d, middle_.forward);
        if (!(depth > 0)) return std::nullopt;
        scale /= depth;
    }
    return Vec2d{0.5 * width_ + scale * dot(d, middle_.right),
                 0.5 * height_ - scale * dot(d, middle_.up)};
}

std::optional<Camera::Sight> Camera::see(const Vec3d& point, Vec2f lens) const {
    const Pose& p = middle_;
    const bool perspective = projection_ == Projection::Perspective;
    const double to_plane = 2 * p.scale / height_;
    Vec3d from_middle;  // of the point of the lens
    if (p.lens_radius > 0) {
        const Vec2d at = aperture_point(lens, blades_, blade_rotation_);
        from_middle = p.lens_radius * (at.x * p.right + at.y * p.up);
    }
    Sight sight;
    sight.is_parallel = !perspective;
    Vec3d offset;  // from the middle of the picture, where the film plane is
    if (perspective) {
        sight.origin = p.position + from_middle;
        const Vec3d way = point - sight.origin;
        const double depth = dot(way, p.forward);
        if (!(depth > 0)) return std::nullopt;
        sight.distance = length(way);
        sight.direction = way / sight.distance;
        // Where the ray meets the plane at depth 1, or the plane in focus, seen from the middle.
        offset = way / depth;
        if (p.lens_radius > 0) offset += from_middle / p.focus_distance;
        const double cosine = depth / sight.distance;
        sight.density = 1 / (to_plane * to_plane * cosine * cosine * cosine);
    } else {
        sight.direction =
            p.lens_radius > 0 ? normalize(p.focus_distance * p.forward - from_middle) : p.forward;
        const double cosine = dot(sight.direction, p.forward);
        sight.distance = dot(point - p.position, p.forward) / cosine;
        if (!(sight.distance > 0)) return std::nullopt;
        sight.origin = point - sight.distance * sight.direction;
        offset = sight.origin - from_middle - p.position;
        sight.density = 1 / (to_plane * to_plane * cosine);
    }
    sight.film = {0.5 * width_ + dot(offset, p.right) / to_plane,
                  0.5 * height_ - dot(offset, p.up) / to_plane};
    return sight;
}

double Camera::pixel_size(double depth) const {
    const double size = 2 * middle_.scale / height_;
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
