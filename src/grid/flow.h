// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/job.h"
#include "grid/brick_volume.h"
#include "grid/frame.h"

namespace gischt {

// The velocity of a frame made ready to carry its fields along for a time that is short against the
// change of the flow: what motion blur needs (Kim & Ko 2007, "Eulerian motion blur").
//
// Many files hold velocity only where there is smoke. Smoke moves on into cells that have none,
// which therefore take the mean of their neighbours, layer by layer, as far as the flow may reach;
// cells of the velocity's background (if that is zero) count as such unless `content` has
// something there, which then rests.
class Flow {
  public:
    // `velocity` has three components in m/s. `seconds` is the longest time, in either direction.
    // Beyond 64 cells nothing is carried into the void; the job is told.
    Flow(const Field& velocity, const Field& content, double seconds, Job& job);

    // m/s at a point in metres.
    Vec3d at(const Vec3d& point) const {
        return {static_cast<double>(axis_[0].sample(point)),
                static_cast<double>(axis_[1].sample(point)),
                static_cast<double>(axis_[2].sample(point))};
    }
    // From where the flow brings something to a point in so many seconds (two-stage Runge-Kutta
    // through the velocity as it is now).
    Vec3d origin(const Vec3d& point, double seconds) const {
        return point - seconds * at(point - 0.5 * seconds * at(point));
    }
    double fastest() const { return fastest_; }                  // m/s, anywhere
    double fastest_content() const { return fastest_content_; }  // m/s, where content is

  private:
    std::array<BrickVolume, 3> axis_;
    double fastest_ = 0, fastest_content_ = 0;
};

// A field as the flow leaves it after `seconds`, which may be negative: each cell takes the value
// from where it comes, by cubic interpolation (Catmull & Rom 1974) kept near the values around and
// not below them.
// On the lattice of the source, with tiles wherever something may arrive.
Field carried(const Field& source, const Flow& flow, double seconds, Job& job);

}  // namespace gischt
