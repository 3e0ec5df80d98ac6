// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace gischt {

// Solid angles of flat shapes seen from a point, in sr, and even sampling of them. A solid angle
// counts from either side; from a point in the plane of the shape it is 0.

// Of a triangle (Van Oosterom & Strackee 1983).
double triangle_solid_angle(const Vec3d& from, const Vec3d& a, const Vec3d& b, const Vec3d& c);

// Of a disc, by its contour; to about 1e-9 of itself from a tenth of a radius on, and coarser close
// to its plane within the radius.
double disc_solid_angle(const Vec3d& from, const Vec3d& center, const Vec3d& normal, double radius);

// A rectangle as seen from a point (Urena, Fajardo, King 2013, "An area-preserving
// parametrization for spherical rectangles").
class SphericalRectangle {
  public:
    // corner + a edge_x + b edge_y, a and b in [0,1]; the edges are perpendicular.
    SphericalRectangle(const Vec3d& from, const Vec3d& corner, const Vec3d& edge_x,
                       const Vec3d& edge_y);

    double solid_angle() const { return solid_angle_; }
    // The point of the rectangle for u in [0,1)^2, even in solid angle.
    Vec3d point(Vec2f u) const;

  private:
    Vec3d from_, x_, y_, z_;
    double x0_, x1_, y0_, y1_, z0_, b0_ = 0, b1_ = 0, k_ = 0, solid_angle_ = 0;
};

// A triangle as seen from a point (Arvo 1995, "Stratified sampling of spherical triangles").
class SphericalTriangle {
  public:
    SphericalTriangle(const Vec3d& from, const Vec3d& a, const Vec3d& b, const Vec3d& c);

    double solid_angle() const { return solid_angle_; }
    // A unit vector for u in [0,1)^2, even in solid angle. The solid angle must not be 0.
    Vec3d direction(Vec2f u) const;

  private:
    Vec3d a_, b_, c_;
    double alpha_ = 0, solid_angle_ = 0;
};

}  // namespace gischt
