// SPDX-License-Identifier: Apache-2.0
#include "optics/box_target.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "shape/solid_angle.h"

namespace gischt {
namespace {

// Below, in sr, the angles of spherical geometry lose their digits: the ball around serves then.
constexpr double least_solid_angle = 1e-6;

Vec3d on_cap(const Vec3d& axis, double one_minus_cos, Vec2f u) {
    const double drop = static_cast<double>(u.x) * one_minus_cos,
                 turn = 2 * pi * static_cast<double>(u.y);
    const double sine = std::sqrt(std::max(0.0, drop * (2 - drop)));
    Vec3d s, t;
    orthonormal_frame(axis, s, t);
    return (1 - drop) * axis + sine * (std::cos(turn) * s + std::sin(turn) * t);
}

}  // namespace

BoxTarget::BoxTarget(const Box3d& box)
    : box_(box), center_(0.5 * (box.lo + box.hi)), radius_(0.5 * length(box.size())) {
    GISCHT_ASSERT(std::isfinite(radius_) && min_component(box.size()) >= 0 && radius_ > 0);
}

bool BoxTarget::is_met_by(const Ray& ray) const {
    const Interval inside = clip(ray, box_);
    return inside.t0 <= inside.t1;
}

bool BoxTarget::surrounds(const Vec3d& p) const {
    return p.x >= box_.lo.x && p.y >= box_.lo.y && p.z >= box_.lo.z && p.x <= box_.hi.x &&
           p.y <= box_.hi.y && p.z <= box_.hi.z;
}

BoxTarget::Side BoxTarget::side(int axis, bool upper) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Side s;
    s.corner = box_.lo;
    if (upper) s.corner[axis] = box_.hi[axis];
    s.edge_x[u] = box_.hi[u] - box_.lo[u];
    s.edge_y[v] = box_.hi[v] - box_.lo[v];
    return s;
}

// Along each axis one side at most is seen from outside.
BoxTarget::Seen BoxTarget::seen_from(const Vec3d& from) const {
    Seen seen;
    for (int a = 0; a < 3; ++a) {
        const bool upper = from[a] > box_.hi[a];
        if (!upper && from[a] >= box_.lo[a]) continue;
        const Side s = side(a, upper);
        if (length(s.edge_x) * length(s.edge_y) == 0) continue;
        seen.angle[a] = SphericalRectangle(from, s.corner, s.edge_x, s.edge_y).solid_angle();
    }
    return seen;
}

double BoxTarget::one_minus_cos_of_ball(const Vec3d& from) const {
    const Vec3d d = center_ - from;
    const double sine2 = radius_ * radius_ / dot(d, d);
    return sine2 < 1 ? sine2 / (1 + std::sqrt(1 - sine2)) : 2;
}

Vec3d BoxTarget::direction(const Vec3d& from, Vec2f u, float choice) const {
    if (surrounds(from)) return on_cap({0, 0, 1}, 2, u);
    const Seen seen = seen_from(from);
    const double sum = seen.sum();
    if (sum < least_solid_angle) {
        return on_cap(normalize(center_ - from), one_minus_cos_of_ball(from), u);
    }
    double left = static_cast<double>(choice) * sum;
    int axis = 0;
    while (axis < 2 && left >= seen.angle[axis]) left -= seen.angle[axis++];
    while (seen.angle[axis] == 0) --axis;  // but for rounding never
    const Side s = side(axis, from[axis] > box_.hi[axis]);
    return normalize(SphericalRectangle(from, s.corner, s.edge_x, s.edge_y).point(u) - from);
}

double BoxTarget::direction_pdf(const Vec3d& from, const Vec3d& direction) const {
    if (surrounds(from)) return 0.25 / pi;
    if (!is_met_by({from, direction})) return 0;
    const double sum = seen_from(from).sum();
    return sum < least_solid_angle ? 1 / (2 * pi * one_minus_cos_of_ball(from)) : 1 / sum;
}

double BoxTarget::area_across(const Vec3d& along) const {
    const Vec3d e = box_.size();
    return e.y * e.z * std::abs(along.x) + e.z * e.x * std::abs(along.y) +
           e.x * e.y * std::abs(along.z);
}

Vec3d BoxTarget::entry(const Vec3d& along, Vec2f u, float choice) const {
    const Vec3d e = box_.size();
    const Vec3d across(e.y * e.z * std::abs(along.x), e.z * e.x * std::abs(along.y),
                       e.x * e.y * std::abs(along.z));
    double left = static_cast<double>(choice) * (across.x + across.y + across.z);
    int axis = 0;
    while (axis < 2 && left >= across[axis]) left -= across[axis++];
    const Side s = side(axis, along[axis] < 0);
    return s.corner + static_cast<double>(u.x) * s.edge_x + static_cast<double>(u.y) * s.edge_y;
}

}  // namespace gischt
