// SPDX-License-Identifier: Apache-2.0
#include "optics/view.h"

namespace gischt {

BackgroundSample background(const View& view, const Vec3d& direction) {
    if (view.background) return {*view.background, 1};
    BackgroundSample sample;
    for (const LightPtr& light : view.lights) {
        if (!light->is_infinite() || !light->camera_visible) continue;
        sample.radiance += light->radiance(direction);
        if (!light->is_delta()) sample.alpha = 1;
    }
    return sample;
}

}  // namespace gischt
