// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fluid/domain.h"

namespace gischt {

// A point of a lattice inside a solid whose value continues a linear profile through the surface:
//   value = wall + share (value at the probe - wall).
struct SurfaceGhost {
    Vec3i point;
    Vec3d probe;       // in the fluid, in indices of the lattice
    double share = 0;  // of the probe's distance from the surface, negative; at least -1
    float wall = 0;    // what the surface holds
};

// `distance` (m, negative) and unit `normal` of the surface at a point inside; axis -1: cells. The
// probe lies as far off the surface as a cell is long across, so that beside a plane all that it is
// interpolated from lies in the fluid. Deeper than that the values stay those of the mirror image.
SurfaceGhost surface_ghost(const Domain& domain, int axis, const Vec3i& point, double distance,
                           const Vec3d& normal, float wall);

// Linear between the points of a lattice with the indices [0, count); held at its ends.
template <class Get>
double interpolate_lattice(const Vec3d& at, const Vec3i& count, Get&& get) {
    Vec3i low, high;
    Vec3d part;
    for (int a = 0; a < 3; ++a) {
        const double x = std::clamp(at[a], 0.0, count[a] - 1.0);
        low[a] = std::min(static_cast<int>(x), std::max(count[a] - 2, 0));
        high[a] = std::min(low[a] + 1, count[a] - 1);
        part[a] = x - low[a];
    }
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
        double weight = 1;
        Vec3i p;
        for (int a = 0; a < 3; ++a) {
            const bool up = ((c >> a) & 1) != 0;
            p[a] = up ? high[a] : low[a];
            weight *= up ? part[a] : 1 - part[a];
        }
        if (weight != 0) sum += weight * static_cast<double>(get(p));
    }
    return sum;
}

// Sets all ghosts from what `get` gives before any is set.
template <class Get, class Set>
void continue_through(const std::vector<SurfaceGhost>& ghosts, const Vec3i& count, Get&& get,
                      Set&& set) {
    std::vector<float> values(ghosts.size());
    parallel_for(static_cast<int>(ghosts.size()), 256, [&](int i) {
        const SurfaceGhost& g = ghosts[static_cast<std::size_t>(i)];
        const double wall = static_cast<double>(g.wall);
        const double probe = g.share == 0 ? wall : interpolate_lattice(g.probe, count, get);
        values[static_cast<std::size_t>(i)] = static_cast<float>(wall + g.share * (probe - wall));
    });
    for (std::size_t i = 0; i < ghosts.size(); ++i) set(ghosts[i].point, values[i]);
}

}  // namespace gischt
