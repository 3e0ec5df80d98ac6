// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "grid/flow.h"
#include "math/keyframes.h"

namespace gischt {

// Turbulence without divergence: the curl of animated noise (Bridson et al. 2007).
struct EddyParams {
    Keyed<double> speed = 0.0;  // m/s, root mean square
    double scale = 0.5;         // m, size of the largest eddies
    int octaves = 2;            // eddies, each half as large; slower by 2^(-1/3) (Kolmogorov 1941)
    double change = 0.5;        // 1/s, how often the pattern changes entirely
    std::int64_t seed = 1;
};

// A vortex line: an infinite straight one, or the parts between `points`.
struct VortexParams {
    Keyed<Vec3d> position;               // m; moves the points too
    Keyed<Vec3d> axis = Vec3d(0, 0, 1);  // of the straight one; turns counterclockwise around it
    std::vector<Vec3d> points;           // m, corners of a curve; the first again closes it
    Keyed<double> circulation = 1.0;     // m^2/s
    double core = 0.05;                  // m, within which the air turns as a whole
};

// The velocity of the air that carries particles: the sum of its parts.
struct AirParams {
    Keyed<Vec3d> wind;  // m/s
    EddyParams turbulence;
    std::vector<VortexParams> vortices;
};

// m/s at a point in metres; unit root mean square times params.speed.
Vec3d eddy_velocity(const EddyParams& params, const Vec3d& point, double time);

// Biot-Savart with a core: |u| = circulation r / (2 pi (r^2 + core^2)) at the distance r of a
// straight line (Rosenhead 1930; Scully 1975), the same regularization for the parts of a curve.
Vec3d vortex_velocity(const VortexParams& params, const Vec3d& point, double time);

class Air {
  public:
    // Throws Error{Usage} for a curve of one point, an axis without length, a core of 0.
    explicit Air(AirParams params);

    // The velocity of another fluid at two moments, in between linear; null for none. Both hold
    // until the next call.
    void set_flow(std::shared_ptr<const Flow> begin, std::shared_ptr<const Flow> end, double from,
                  double to);
    Vec3d velocity(const Vec3d& point, double time) const;

  private:
    AirParams params_;
    std::shared_ptr<const Flow> begin_, end_;
    double from_ = 0, to_ = 1;
};

}  // namespace gischt
