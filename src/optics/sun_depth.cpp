// SPDX-License-Identifier: Apache-2.0
#include "optics/sun_depth.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/interpolate.h"
#include "math/ray.h"
#include "optics/medium_depth.h"

namespace gischt {

SunDepth::SunDepth(const Medium& medium, const Vec3d& towards, double spacing, Job& job) {
    const Medium::Lattice lattice = medium.lattice();
    if (!(lattice.box.lo.x < lattice.box.hi.x)) return;
    to_world_ = lattice.to_world * Transform::scale_translate(spacing, {});
    to_lattice_ = to_world_.inverse();
    const Vec3d lo = lattice.box.lo / Vec3d(spacing), hi = lattice.box.hi / Vec3d(spacing);
    box_ = {Vec3d(floor(lo)), Vec3d(-floor(-hi))};

    // The planes are stacked along the axis nearest to the light.
    towards_ = to_lattice_.vector(towards);
    const Vec3d size = abs(towards_);
    axis_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    u_ = axis_ == 0 ? 1 : 0;
    v_ = axis_ == 2 ? 1 : 2;
    towards_ = towards_ / Vec3d(std::abs(towards_[axis_]));
    step_length_ = length(to_world_.vector(towards_));
    sign_ = towards_[axis_] > 0 ? -1 : 1;
    first_ = sign_ > 0 ? box_.lo[axis_] : box_.hi[axis_];
    slope_u_ = -towards_[u_];
    slope_v_ = -towards_[v_];
    // Two columns more on each side: a look-up follows the rays up to one column out.
    low_u_ = box_.lo[u_] - 2;
    low_v_ = box_.lo[v_] - 2;
    nu_ = static_cast<int>(box_.hi[u_] - box_.lo[u_]) + 4;
    nv_ = static_cast<int>(box_.hi[v_] - box_.lo[v_]) + 4;

    make_planes();
    nodes_.resize(planes_.size() * static_cast<std::size_t>(nu_) * static_cast<std::size_t>(nv_));
    for (int p = 1; p < static_cast<int>(planes_.size()); ++p) {
        job.check();
        sweep(medium, p);
    }
}

// Columns keep their place within a plane's cells by wrapping: when a ray has moved by a whole
// cell it takes the next index, and a column that enters from the side starts at 0.
void SunDepth::make_planes() {
    const int count = static_cast<int>(box_.hi[axis_] - box_.lo[axis_]) + 1;
    int last_u = 0, last_v = 0;
    for (int p = 0; p < count; ++p) {
        const double at_u = slope_u_ * p, at_v = slope_v_ * p;
        const int whole_u = static_cast<int>(std::floor(at_u)),
                  whole_v = static_cast<int>(std::floor(at_v));
        planes_.push_back({static_cast<float>(at_u - whole_u), static_cast<float>(at_v - whole_v),
                           whole_u - last_u, whole_v - last_v});
        last_u = whole_u;
        last_v = whole_v;
    }
}

// A point of the lattice by plane and columns, in metres.
Vec3d SunDepth::node(double plane, double u, double v) const {
    Vec3d q;
    q[axis_] = first_ + sign_ * plane;
    q[u_] = low_u_ + u;
    q[v_] = low_v_ + v;
    return to_world_.point(q);
}

// Adds the step from plane p - 1 to p by Simpson's rule.
void SunDepth::sweep(const Medium& medium, int p) {
    const Plane plane = planes_[static_cast<std::size_t>(p)];
    Vec3d along;
    along[u_] = 1;
    const Vec3d direction = to_world_.vector(along);
    const auto step = static_cast<float>(step_length_);
    parallel_ranges(nv_, 8, [&](int begin, int end) {
        std::vector<float> here(static_cast<std::size_t>(nu_)),
            middle(static_cast<std::size_t>(nu_));
        for (int j = begin; j < end; ++j) {
            const double u = static_cast<double>(plane.shift_u),
                         v = j + static_cast<double>(plane.shift_v);
            densities_on_line(medium, {node(p, u, v), direction}, 0, 1, here);
            densities_on_line(medium,
                              {node(p - 0.5, u - 0.5 * slope_u_, v - 0.5 * slope_v_), direction}, 0,
                              1, middle);
            const int from_j = j - plane.step_v;
            const bool is_row_inside = from_j >= 0 && from_j < nv_;
            for (int i = 0; i < nu_; ++i) {
                const auto k = static_cast<std::size_t>(i);
                Node& out = nodes_[index(p, i, j)];
                out.slope = step * here[k];
                const int from_i = i - plane.step_u;
                if (!is_row_inside || from_i < 0 || from_i >= nu_) continue;
                const Node& before = nodes_[index(p - 1, from_i, from_j)];
                out.depth =
                    before.depth + (before.slope + 4 * step * middle[k] + out.slope) * (1.0f / 6);
            }
        }
    });
}

// Bilinear inside a plane.
SunDepth::Mixed SunDepth::at(int plane, float u, float v) const {
    const int i = std::clamp(static_cast<int>(u), 0, nu_ - 2),
              j = std::clamp(static_cast<int>(v), 0, nv_ - 2);
    const Node* n = nodes_.data() + index(plane, i, j);
    const float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
    const auto mix = [&](float Node::*m) {
        return lerp(lerp(n[0].*m, n[1].*m, fu), lerp(n[nu_].*m, n[nu_ + 1].*m, fu), fv);
    };
    const auto [least, most] =
        std::minmax({n[0].depth, n[1].depth, n[nu_].depth, n[nu_ + 1].depth});
    return {mix(&Node::depth), mix(&Node::slope), most - least};
}

SunDepth::Found SunDepth::find(const Vec3d& point) const {
    if (planes_.empty()) return {};
    Vec3d q = to_lattice_.point(point);
    if (!box_.contains(q)) {
        const Interval inside = clip({q, towards_}, box_);
        if (inside.is_empty()) return {};
        q = q + inside.t0 * towards_;
    }
    // Where the ray through the point meets the planes before and behind it.
    const int last = static_cast<int>(planes_.size()) - 1;
    const double s = std::clamp((q[axis_] - first_) * sign_, 0.0, static_cast<double>(last));
    const int p = std::min(static_cast<int>(s), last - 1);
    const double w = s - p;
    const Plane &near = planes_[static_cast<std::size_t>(p)],
                &far = planes_[static_cast<std::size_t>(p) + 1];
    const float u = static_cast<float>(q[u_] - slope_u_ * w - low_u_) - near.shift_u;
    const float v = static_cast<float>(q[v_] - slope_v_ * w - low_v_) - near.shift_v;
    const Mixed a = at(p, u, v);
    const Mixed b =
        at(p + 1, u + static_cast<float>(far.step_u), v + static_cast<float>(far.step_v));

    // Cubic Hermite, which rounding and bilinear slopes may take slightly out of [a, b].
    const auto t = static_cast<float>(w);
    const float d = b.depth - a.depth;
    const float cubic =
        a.depth +
        t * (a.slope + t * (3 * d - 2 * a.slope - b.slope + t * (a.slope + b.slope - 2 * d)));
    return {std::clamp(cubic, std::min(a.depth, b.depth), std::max(a.depth, b.depth)),
            std::max(a.range, b.range)};
}

}  // namespace gischt
