// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

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

    // The aperture: a radius or an f-number; both 0: a pinhole, everything is sharp.
    Keyed<double> lens_radius{0};                 // m
    Keyed<double> f_number{0};                    // focal length / diameter
    double sensor_height = 0.024;                 // m, makes a focal length of the field of view
    std::optional<Keyed<double>> focus_distance;  // m along the view axis; unset: the target's
    std::optional<Keyed<Vec3d>> focus_target;     // a point that is sharp, in its place
    int blades = 0;                               // corners of the aperture; below 3: a disc
    double blade_rotation_degrees = 0;
};

const Table<CameraParams>& camera_table();

// A camera for a picture of width x height square pixels, at one moment and around it while the
// shutter is open. Pixel (x, y) has its centre at (x + 1/2, y + 1/2), x to the right, y down.
//
// With an aperture it is a thin lens whose image of the plane at the focus distance is sharp and
// fills the picture as that of the pinhole in its centre: focussing does not change the field of
// view. A point at depth z is seen as a disc of the diameter 2 R |z - s| / z / pixel_size(s) pixels
// for the focus distance s and the lens radius R.
class Camera {
  public:
    Camera() = default;
    // `scene_up` is taken when the parameters name none. An up vector parallel to the view is
    // replaced by any other. `shutter` in seconds, centred on time: parameters with keyframes move
    // during it. Throws Error{Usage} when target and position coincide, when nothing can be in
    // focus, and when the aperture or the focus is given twice.
    Camera(const CameraParams& params, double time, int width, int height,
           const Vec3d& scene_up = {0, 0, 1}, double shutter = 0);

    // The ray through a point of the picture, in pixels; its direction has unit length, t_min = 0.
    // `lens` in [0,1)^2 chooses the point of the aperture, `time` in [0,1) the moment between the
    // opening and the closing of the shutter.
    Ray ray(double x, double y, Vec2f lens = {0.5f, 0.5f}, double time = 0.5) const;
    // Whether `lens` makes a difference.
    bool has_aperture() const { return middle_.lens_radius > 0; }
    // Distance along the view axis (the Z of an image) of the point ray.at(t), metres.
    // From the camera at the middle of the shutter's time.
    double depth(const Ray& ray, double t) const {
        return dot(ray.at(t) - middle_.position, middle_.forward);
    }
    // Where a point appears, in pixels, at the middle of the shutter's time and through the middle
    // of the lens; nothing behind a perspective camera.
    std::optional<Vec2d> project(const Vec3d& point) const;
    // How a point in space is seen through the point `lens` of the aperture, in the middle of the
    // shutter's time: the inverse of ray(). Nothing behind a perspective camera.
    struct Sight {
        Vec2d film;           // pixels; may lie outside of the picture
        Vec3d origin;         // of the ray
        Vec3d direction;      // of the ray, unit
        double distance = 0;  // along it, metres
        // Film area per solid angle at the origin, pixels/sr; where all rays through `lens` are
        // parallel (is_parallel) per area across the direction, pixels/m^2.
        double density = 0;
        bool is_parallel = false;
    };
    std::optional<Sight> see(const Vec3d& point, Vec2f lens = {0.5f, 0.5f}) const;
    // Edge of a pixel in metres at a depth along the view axis, at the picture's centre.
    double pixel_size(double depth) const;

    Projection projection() const { return projection_; }
    // At the middle of the shutter's time.
    const Vec3d& position() const { return middle_.position; }
    const Vec3d& forward() const { return middle_.forward; }  // unit, mutually orthogonal
    const Vec3d& right() const { return middle_.right; }
    const Vec3d& up() const { return middle_.up; }
    double lens_radius() const { return middle_.lens_radius; }        // m
    double focus_distance() const { return middle_.focus_distance; }  // m along the view axis
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    // What the parameters say of one moment.
    struct Pose {
        Vec3d position{0, -5, 1}, right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
        double scale = 0.36397023426620234;  // half the height of the picture at depth 1 (or in m)
        double lens_radius = 0, focus_distance = 5;
    };
    static Pose pose_at(const CameraParams& params, double time, const Vec3d& scene_up);
    Pose pose(double time) const;

    Projection projection_ = Projection::Perspective;
    Pose middle_;
    // At equidistant moments from the opening to the closing of the shutter; empty at rest.
    std::vector<Pose> moving_;
    int blades_ = 0;
    double blade_rotation_ = 0;  // radians
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
