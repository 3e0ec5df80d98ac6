// SPDX-License-Identifier: Apache-2.0
#include "grid/frame.h"

#include "math/interpolate.h"

namespace gischt {

double Field::cell_size() const {
    return std::max(
        {length(to_world.column[0]), length(to_world.column[1]), length(to_world.column[2])});
}

Box3d Field::world_bounds() const {
    const Box3i& b = map().bounds();
    return to_world.bounds({Vec3d(b.lo), Vec3d(b.hi)});
}

float Field::sample(const Vec3d& world, int axis) const {
    const Vec3d p = to_world.inverse().point(world) - Vec3d(0.5);
    const Vec3i c = floor(p);
    const Vec3f f(p - Vec3d(c));
    const auto a = static_cast<std::size_t>(axis);
    float plane[2];
    for (int k = 0; k < 2; ++k) {
        float row[2];
        for (int j = 0; j < 2; ++j) {
            row[j] = lerp(component[a].get(c + Vec3i(0, j, k), background[a]),
                          component[a].get(c + Vec3i(1, j, k), background[a]), f.x);
        }
        plane[k] = lerp(row[0], row[1], f.y);
    }
    return lerp(plane[0], plane[1], f.z);
}

Box3d Frame::world_bounds() const {
    Box3d box = Box3d::empty();
    for (const auto& [name, field] : fields) {
        if (field.map().size() > 0) box.extend(field.world_bounds());
    }
    return box;
}

}  // namespace gischt
