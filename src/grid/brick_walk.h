// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>

#include "grid/brick_volume.h"
#include "math/ray.h"

namespace gischt {

// A run of a ray inside one block, or one brick, of a BrickVolume.
struct BrickRun {
    double t0 = 0, t1 = 0;
    BrickVolume::Block bounds;  // minimum, mean and maximum of the interpolant over the block
    int brick = 0;
    int block = -1;  // of the brick; -1: all of it
    Vec3i coord;     // of the brick
    Vec3f entry;     // the brick's local coordinates at t0
};

// Blocks: 4^3 cells, tight bounds. Bricks: 8^3 cells, half as many runs.
enum class BrickGrain { Blocks, Bricks };

// Visits the blocks or bricks along a ray in order, those that hold only the background left out: a
// digital differential analyser over bricks (Amanatides & Woo 1987), the crossing times being
// computed from the planes themselves so that nothing drifts, and the three middle planes inside
// each. Consecutive runs that touch share their t. The volume must outlive the walk.
class BrickWalk {
  public:
    BrickWalk(const BrickVolume& volume, const Ray& world, BrickGrain grain = BrickGrain::Blocks);

    // The next run; false at the end.
    bool next(BrickRun& run);
    // Local coordinates per unit of t.
    const Vec3f& step() const { return step_; }

  private:
    // Time at which the ray crosses the plane q[axis] = value.
    double crossing(std::size_t axis, double value) const {
        return (value - origin_[axis]) * inverse_[axis];
    }
    void start(const Interval& inside);
    bool enter_brick();
    void leave_brick();
    void next_brick();
    void split_brick();
    void fill(BrickRun& run, double t0, double t1) const;

    const BrickVolume* volume_;
    BrickGrain grain_;
    std::array<double, 3> origin_, direction_, inverse_;
    Vec3f step_;
    std::array<int, 3> coord_{}, sign_{};
    std::array<double, 3> leave_{};  // where the ray leaves the current brick, by axis
    double t_ = 0, t_end_ = -1;      // where the current brick begins; where the walk ends
    double t_leave_ = -1;            // where the current brick ends
    std::size_t leave_axis_ = 0;
    int brick_ = -1;
    // The current brick's runs: block by block between the times of cut_.
    std::array<double, 5> cut_;
    std::array<int, 4> cut_block_;
    std::size_t cuts_ = 0, cut_at_ = 0;
};

}  // namespace gischt
