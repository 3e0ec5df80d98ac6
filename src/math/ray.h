// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "math/box.h"
#include "math/vec.h"

namespace gischt {

// origin + t direction, t in [t_min, t_max]. The direction need not have unit length; t counts in
// its lengths.
struct Ray {
    Vec3d origin, direction{0, 0, 1};
    double t_min = 0, t_max = std::numeric_limits<double>::infinity();

    Vec3d at(double t) const { return origin + t * direction; }
};

struct Interval {
    double t0 = 0, t1 = -1;
    bool is_empty() const { return !(t0 < t1); }
};

// The part of the ray inside the box, clipped to [t_min, t_max]: slab method (Kay & Kajiya 1986).
inline Interval clip(const Ray& ray, const Box3d& box) {
    double t0 = ray.t_min, t1 = ray.t_max;
    for (int a = 0; a < 3; ++a) {
        const double d = ray.direction[a], o = ray.origin[a];
        if (d == 0) {
            if (o < box.lo[a] || o > box.hi[a]) return {};
            continue;
        }
        double near = (box.lo[a] - o) / d, far = (box.hi[a] - o) / d;
        if (near > far) std::swap(near, far);
        t0 = std::max(t0, near);
        t1 = std::min(t1, far);
    }
    return {t0, t1};
}

}  // namespace gischt
