// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/camera.h"

namespace gischt {

// A camera that a hand moves around a point. Angles in radians, lengths in metres.
class Orbit {
  public:
    Orbit() = default;
    // Takes the place of `params` at a time. `up` is of unit length.
    Orbit(const CameraParams& params, double time, const Vec3d& up);

    // Around the target: to the right and upwards. The poles are not crossed.
    void turn(double right, double upwards);
    // Camera and target together, in heights of the picture at the target's distance.
    void pan(double right, double upwards);
    // Nearer for factors below 1.
    void dolly(double factor);

    const Vec3d& target() const { return target_; }
    double distance() const { return distance_; }
    Vec3d position() const;
    // The parameters that it began with, position and target held still.
    CameraParams params() const;
    // Where the ray of a camera through the pixel meets the plane across the view through the
    // target.
    static Vec3d point_at(const Camera& camera, Vec2d pixel, const Vec3d& target);

  private:
    Vec3d outwards() const;  // from the target to the camera, unit

    CameraParams params_;
    Vec3d up_{0, 0, 1}, east_{1, 0, 0}, north_{0, 1, 0}, target_;
    double distance_ = 1, azimuth_ = 0, elevation_ = 0, height_ = 1;
};

}  // namespace gischt
