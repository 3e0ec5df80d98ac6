// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>

#include "grid/brick_volume.h"
#include "math/ray.h"

namespace gischt {

// A run of a ray inside one block of a BrickVolume.
struct BlockRun {
    double t0 = 0, t1 = 0;
    BrickVolume::Block bounds;  // minimum, mean and maximum of the interpolant over the block
    int brick = 0;
    Vec3i coord;  // of the brick
    Vec3f entry;  // the brick's local coordinates at t0
};

// Visits the blocks along a ray in order, those that hold only the background left out: a digital
// differential analyser over bricks (Amanatides & Woo 1987), the crossing times being computed
// from the planes themselves so that nothing drifts, and the three middle planes inside each.
// Consecutive runs of touching blocks share their t. The volume must outlive the walk.
class BrickWalk {
  public:
    BrickWalk(const BrickVolume& volume, const Ray& world);

    // The next run; false at the end.
    bool next(BlockRun& run);
    // Local coordinates per unit of t.
    const Vec3f& step() const { return step_; }

  private:
    static constexpr double never = std::numeric_limits<double>::infinity();

    // Time at which the ray crosses the plane q[axis] = value.
    double crossing(int axis, double value) const {
        return (value - origin_[axis]) * inverse_[axis];
    }
    bool enter_brick();
    void leave_brick();
    void split_brick();

    const BrickVolume& volume_;
    Vec3d origin_, direction_, inverse_;
    Vec3f step_;
    Vec3i coord_, direction_sign_;
    double t_ = 0, t_end_ = -1;  // where the current brick begins; where the walk ends
    double t_leave_ = -1;        // where the current brick ends
    int leave_axis_ = 0;
    int brick_ = -1;
    // The current brick's runs: block by block between the times of cut_.
    std::array<double, 5> cut_{};
    std::array<int, 4> cut_block_{};
    int cuts_ = 0, cut_at_ = 0;
};

}  // namespace gischt
