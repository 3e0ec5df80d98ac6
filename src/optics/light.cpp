// SPDX-License-Identifier: Apache-2.0
#include "optics/light.h"

namespace gischt {

Vec3f infinite_radiance(const std::vector<LightPtr>& lights, const Vec3d& direction,
                        bool camera_ray) {
    Vec3f sum;
    for (const LightPtr& light : lights) {
        if (!light->is_infinite() || (camera_ray && !light->camera_visible)) continue;
        sum += light->radiance(direction);
    }
    return sum;
}

}  // namespace gischt
