// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/box.h"
#include "math/ray.h"

namespace gischt {

// A finite box that rays are sent to: the directions from a point that meet it, and the places of
// the beam of parallel rays that meets it. Both are drawn without rejection, but for boxes that
// fill less than 1e-6 sr.
class BoxTarget {
  public:
    // An edge may be 0, not two of them.
    explicit BoxTarget(const Box3d& box);

    const Box3d& box() const { return box_; }
    bool is_met_by(const Ray& ray) const;
    bool surrounds(const Vec3d& point) const;

    // Directions from a point, even over the solid angle of the box; over all from inside of it.
    // `choice` and u in [0,1). A tiny box may be missed.
    Vec3d direction(const Vec3d& from, Vec2f u, float choice) const;
    // The density of these, 1/sr; 0 for one that misses the box.
    double direction_pdf(const Vec3d& from, const Vec3d& direction) const;

    // The cross section of the box along a unit vector, m^2.
    double area_across(const Vec3d& along) const;
    // A point where a ray that travels along a unit vector enters the box, even over the cross
    // section.
    Vec3d entry(const Vec3d& along, Vec2f u, float choice) const;

  private:
    struct Side {
        Vec3d corner, edge_x, edge_y;
    };
    Side side(int axis, bool upper) const;
    // Solid angle, by axis, of the side that a point outside sees.
    struct Seen {
        double angle[3] = {0, 0, 0};
        double sum() const { return angle[0] + angle[1] + angle[2]; }
    };
    Seen seen_from(const Vec3d& from) const;
    double one_minus_cos_of_ball(const Vec3d& from) const;

    Box3d box_;
    Vec3d center_;
    double radius_;  // of the ball around
};

}  // namespace gischt
