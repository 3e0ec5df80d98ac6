// SPDX-License-Identifier: Apache-2.0
#include "grid/brick_walk.h"

#include <algorithm>
#include <cmath>

namespace gischt {

static constexpr double never = std::numeric_limits<double>::infinity();
static constexpr int edge = BrickVolume::brick_edge;

BrickWalk::BrickWalk(const BrickVolume& volume, const Ray& world, BrickGrain grain)
    : volume_(&volume), grain_(grain) {
    if (volume.size() == 0) return;
    const Vec3d o = volume.to_lattice().point(world.origin);
    Vec3d d = volume.to_lattice().vector(world.direction);
    // A component this small would not move the ray by a cell before it is out of sight.
    const double least = 1e-20 * max_component(abs(d));
    for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(a);
        if (std::abs(d[a]) <= least) d[a] = 0;
        origin_[i] = o[a];
        direction_[i] = d[a];
        inverse_[i] = 1 / d[a];
        sign_[i] = d[a] > 0 ? 1 : d[a] < 0 ? -1 : 0;
    }
    step_ = Vec3f(d);
    const Box3i& support = volume.support();
    const Interval inside =
        clip({o, d, world.t_min, world.t_max}, {Vec3d(support.lo), Vec3d(support.hi)});
    if (!inside.is_empty()) start(inside);
}

// Finds the first brick. Rounding may put the entry point beside it, and a ray that lies in a face
// belongs to the bricks above.
void BrickWalk::start(const Interval& inside) {
    t_ = inside.t0;
    t_end_ = inside.t1;
    const Box3i& support = volume_->support();
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        const int first = support.lo[axis] >> 3, last = (support.hi[axis] - 1) >> 3;
        const double q = origin_[a] + t_ * direction_[a];
        coord_[a] = std::clamp(static_cast<int>(std::floor(q / edge)), first, last);
        leave_[a] = sign_[a] == 0
                        ? never
                        : crossing(a, static_cast<double>(edge * (coord_[a] + (sign_[a] > 0))));
    }
    leave_brick();
}

// Finds through which face the ray leaves the brick at coord_.
void BrickWalk::leave_brick() {
    leave_axis_ = leave_[0] <= leave_[1] ? (leave_[0] <= leave_[2] ? 0 : 2)
                                         : (leave_[1] <= leave_[2] ? 1 : 2);
    t_leave_ = std::min(leave_[leave_axis_], t_end_);
}

void BrickWalk::next_brick() {
    t_ = std::max(t_, t_leave_);
    const std::size_t a = leave_axis_;
    coord_[a] += sign_[a];
    leave_[a] = sign_[a] == 0
                    ? never
                    : crossing(a, static_cast<double>(edge * (coord_[a] + (sign_[a] > 0))));
    leave_brick();
}

// Steps on until a stored brick; false at the end of the walk.
bool BrickWalk::enter_brick() {
    for (; t_ < t_end_; next_brick()) {
        brick_ = t_ < t_leave_ ? volume_->find({coord_[0], coord_[1], coord_[2]}) : -1;
        if (brick_ >= 0) return true;
    }
    return false;
}

// Cuts the ray's part of the brick at the three planes through its middle.
void BrickWalk::split_brick() {
    int block = 0;
    struct Crossing {
        double t;
        int bit;
    };
    std::array<Crossing, 3> cross;
    std::size_t crossings = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const int bit = 1 << a;
        const double middle = edge * coord_[a] + edge / 2;
        if (sign_[a] == 0) {
            if (origin_[a] >= middle) block |= bit;
            continue;
        }
        // Before the crossing a ray that ascends is in the lower half.
        const double t = crossing(a, middle);
        const bool crossed = t <= t_;
        if (crossed == (sign_[a] > 0)) block |= bit;
        if (!crossed && t < t_leave_) {
            std::size_t at = crossings++;
            for (; at > 0 && cross[at - 1].t > t; --at) cross[at] = cross[at - 1];
            cross[at] = {t, bit};
        }
    }
    cuts_ = 0;
    cut_[0] = t_;
    for (std::size_t c = 0; c < crossings; ++c) {
        if (cross[c].t > cut_[cuts_]) {
            cut_block_[cuts_++] = block;
            cut_[cuts_] = cross[c].t;
        }
        block ^= cross[c].bit;
    }
    cut_block_[cuts_++] = block;
    cut_[cuts_] = t_leave_;
}

void BrickWalk::fill(BrickRun& run, double t0, double t1) const {
    run.t0 = t0;
    run.t1 = t1;
    run.brick = brick_;
    run.coord = {coord_[0], coord_[1], coord_[2]};
    const auto local = [&](std::size_t a) {
        return static_cast<float>(origin_[a] + t0 * direction_[a] - edge * coord_[a]);
    };
    run.entry = {local(0), local(1), local(2)};
}

bool BrickWalk::next(BrickRun& run) {
    if (grain_ == BrickGrain::Bricks) {
        if (!enter_brick()) return false;
        fill(run, t_, t_leave_);
        run.block = -1;
        run.bounds = volume_->whole(brick_);
        next_brick();
        return true;
    }
    for (;;) {
        for (; cut_at_ < cuts_; ++cut_at_) {
            const int block = cut_block_[cut_at_];
            if (!(volume_->occupied(brick_) >> block & 1)) continue;
            fill(run, cut_[cut_at_], cut_[cut_at_ + 1]);
            run.block = block;
            run.bounds = volume_->block(brick_, block);
            ++cut_at_;
            return true;
        }
        if (cuts_ > 0) next_brick();
        cuts_ = cut_at_ = 0;
        if (!enter_brick()) return false;
        split_brick();
    }
}

}  // namespace gischt
