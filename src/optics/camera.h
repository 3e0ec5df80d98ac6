// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/box.h"
#include "math/keyframes.h"
#include "math/ray.h"
#include "math/vec.h"
#include "schema/table.h"

namespace gischt {

enum class Projection { Perspective, Orthographic };

// The camera of a scene file.
struct CameraParams {
    Projection projection = Projection::Perspective;
    Keyed<Vec3d> position{Vec3d{0, -5, 1}};  // m
    Keyed<Vec3d> target{Vec3d{0, 0, 1}};     // m
    std::optional<Keyed<Vec3d>> up;          // unset: the scene's up axis
    Keyed<double> fov_degrees{40};           // full vertical field, perspective
    Keyed<double> height{2};                 // m, full height of the picture, orthographic
    Keyed<double> roll_degrees{0};           // positive: the picture's content turns clockwise
};

const Table<CameraParams>& camera_table();

// A camera at one moment for a picture of width x height square pixels. Pixel (x, y) has its centre
// at (x + 1/2, y + 1/2), x to the right, y down.
class Camera {
  public:
    Camera() = default;
    // `scene_up` is taken when the parameters name none. An up vector parallel to the view is
    // replaced by any other. Throws Error{Usage} when target and position coincide.
    Camera(const CameraParams& params, double time, int width, int height,
           const Vec3d& scene_up = {0, 0, 1});

    // The ray through a point of the picture, in pixels; its direction has unit length, t_min = 0.
    // `lens` in [0,1)^2 chooses the point of the aperture, `time` in [0,1) the moment between the
    // opening and the closing of the shutter.
    Ray ray(double x, double y, Vec2f lens = {0.5f, 0.5f}, double time = 0.5) const;
    // Whether `lens` makes a difference.
    bool has_aperture() const { return false; }
    // Distance along the view axis (the Z of an image) of the point ray.at(t), metres.
    double depth(const Ray& ray, double t) const { return t * dot(ray.direction, forward_); }
    // Where a point appears, in pixels; nothing behind a perspective camera.
    std::optional<Vec2d> project(const Vec3d& point) const;
    // Edge of a pixel in metres at a depth along the view axis, at the picture's centre.
    double pixel_size(double depth) const;

    Projection projection() const { return projection_; }
    const Vec3d& position() const { return position_; }
    const Vec3d& forward() const { return forward_; }  // unit vectors, mutually orthogonal
    const Vec3d& right() const { return right_; }
    const Vec3d& up() const { return up_; }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    Projection projection_ = Projection::Perspective;
    Vec3d position_{0, -5, 1}, right_{1, 0, 0}, up_{0, 0, 1}, forward_{0, 1, 0};
    double scale_ = 0.36397023426620234;  // half the height of the picture at depth 1 (or in m)
    int width_ = 1, height_ = 1;
};

// How fit_camera looks at a box.
struct Framing {
    double azimuth_degrees = 30;    // 0: from -y (z up) or +z (y up); counterclockwise from above
    double elevation_degrees = 15;  // above the horizon
    double fov_degrees = 35;        // full vertical field
    double margin = 0.05;           // free share of the picture on each side
    double aspect = 16.0 / 9;       // width / height
    Vec3d up{0, 0, 1};
};

// The perspective camera that sees the box from that side as large as it fits into the picture:
// exact, all eight corners are inside and two opposite sides touch the margin. Throws Error{Usage}
// for an empty or infinite box.
CameraParams fit_camera(const Box3d& box, const Framing& framing);

}  // namespace gischt
