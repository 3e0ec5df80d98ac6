// SPDX-License-Identifier: Apache-2.0
#include "fluid/surface_ghosts.h"

#include <cmath>

namespace gischt {

SurfaceGhost surface_ghost(const Domain& domain, int axis, const Vec3i& point, double distance,
                           const Vec3d& normal, float wall) {
    SurfaceGhost g;
    g.point = point;
    g.wall = wall;
    if (!(length(normal) > 0)) return g;  // in the very middle of a solid
    const double reach = std::sqrt(static_cast<double>(domain.axes())) * domain.h;
    const Vec3d center = axis < 0 ? domain.center_of(point) : domain.face_center(axis, point);
    const Vec3d probe = (center + (reach - distance) * normal - domain.origin) / domain.h;
    for (int a = 0; a < 3; ++a) g.probe[a] = a == axis ? probe[a] : probe[a] - 0.5;
    g.share = std::max(distance / reach, -1.0);
    return g;
}

}  // namespace gischt
