// SPDX-License-Identifier: Apache-2.0
#include "grid/brick_walk.h"

#include <algorithm>
#include <cmath>

namespace gischt {

BrickWalk::BrickWalk(const BrickVolume& volume, const Ray& world) : volume_(volume) {
    if (volume.size() == 0) return;
    origin_ = volume.to_lattice().point(world.origin);
    direction_ = volume.to_lattice().vector(world.direction);
    // A component this small would not move the ray by a cell before it is out of sight.
    const double least = 1e-20 * max_component(abs(direction_));
    for (int a = 0; a < 3; ++a) {
        if (std::abs(direction_[a]) <= least) direction_[a] = 0;
    }
    step_ = Vec3f(direction_);
    for (int a = 0; a < 3; ++a) {
        inverse_[a] = 1 / direction_[a];
        direction_sign_[a] = direction_[a] > 0 ? 1 : direction_[a] < 0 ? -1 : 0;
    }
    const Box3i& support = volume.support();
    const Interval inside = clip({origin_, direction_, world.t_min, world.t_max},
                                 {Vec3d(support.lo), Vec3d(support.hi)});
    if (inside.is_empty()) return;
    t_ = inside.t0;
    t_end_ = inside.t1;

    // The first brick; rounding may put the entry point beside it, and a ray that lies in a face
    // belongs to the bricks above.
    constexpr int edge = BrickVolume::brick_edge;
    const Vec3d q = origin_ + t_ * direction_;
    for (int a = 0; a < 3; ++a) {
        const int first = support.lo[a] >> 3, last = (support.hi[a] - 1) >> 3;
        coord_[a] = std::clamp(static_cast<int>(std::floor(q[a] / edge)), first, last);
    }
    leave_brick();
}

// Finds where the brick at coord_ ends.
void BrickWalk::leave_brick() {
    constexpr int edge = BrickVolume::brick_edge;
    t_leave_ = never;
    for (int a = 0; a < 3; ++a) {
        if (direction_sign_[a] == 0) continue;
        const double t = crossing(a, double{edge} * (coord_[a] + (direction_sign_[a] > 0)));
        if (t < t_leave_) {
            t_leave_ = t;
            leave_axis_ = a;
        }
    }
    t_leave_ = std::min(t_leave_, t_end_);
}

// Steps on until a stored brick; false at the end of the walk.
bool BrickWalk::enter_brick() {
    while (t_ < t_end_) {
        brick_ = volume_.find(coord_);
        if (brick_ >= 0 && t_ < t_leave_) {
            split_brick();
            return true;
        }
        t_ = std::max(t_, t_leave_);
        coord_[leave_axis_] += direction_sign_[leave_axis_];
        leave_brick();
    }
    return false;
}

// Cuts the ray's part of the brick at the three planes through its middle.
void BrickWalk::split_brick() {
    const Vec3d base = Vec3d(coord_ * BrickVolume::brick_edge);
    int block = 0;
    struct Crossing {
        double t;
        int axis;
    };
    std::array<Crossing, 3> cross;
    std::size_t crossings = 0;
    for (int a = 0; a < 3; ++a) {
        const double middle = base[a] + 4;
        if (direction_sign_[a] == 0) {
            block |= (origin_[a] >= middle) << a;
            continue;
        }
        // Before the crossing a ray that ascends is in the lower half.
        const double t = crossing(a, middle);
        const bool crossed = t <= t_;
        block |= (crossed == (direction_sign_[a] > 0)) << a;
        if (!crossed && t < t_leave_) {
            std::size_t at = crossings++;
            for (; at > 0 && cross[at - 1].t > t; --at) cross[at] = cross[at - 1];
            cross[at] = {t, a};
        }
    }
    cuts_ = cut_at_ = 0;
    cut_[0] = t_;
    for (std::size_t c = 0; c < crossings; ++c) {
        const auto [t, axis] = cross[c];
        if (t > cut_[static_cast<std::size_t>(cuts_)]) {
            cut_block_[static_cast<std::size_t>(cuts_++)] = block;
            cut_[static_cast<std::size_t>(cuts_)] = t;
        }
        block ^= 1 << axis;
    }
    cut_block_[static_cast<std::size_t>(cuts_++)] = block;
    cut_[static_cast<std::size_t>(cuts_)] = t_leave_;
}

bool BrickWalk::next(BlockRun& run) {
    for (;;) {
        while (cut_at_ < cuts_) {
            const auto c = static_cast<std::size_t>(cut_at_++);
            const int block = cut_block_[c];
            if (!(volume_.occupied(brick_) >> block & 1)) continue;
            run.t0 = cut_[c];
            run.t1 = cut_[c + 1];
            run.bounds = volume_.block(brick_, block);
            run.brick = brick_;
            run.coord = coord_;
            run.entry =
                Vec3f(origin_ + run.t0 * direction_ - Vec3d(coord_ * BrickVolume::brick_edge));
            return true;
        }
        if (cuts_ > 0) {
            // Done with this brick.
            cuts_ = cut_at_ = 0;
            t_ = std::max(t_, t_leave_);
            coord_[leave_axis_] += direction_sign_[leave_axis_];
            leave_brick();
        }
        if (!enter_brick()) return false;
    }
}

}  // namespace gischt
