// SPDX-License-Identifier: Apache-2.0
#include "optics/view.h"

namespace gischt {

Vec2f picture_motion(const FrameCameras& around, const Vec3d& before, const Vec3d& after) {
    const auto from = around.before.project(before), to = around.after.project(after);
    if (!from || !to) return {};
    return {static_cast<float>(to->x - from->x), static_cast<float>(to->y - from->y)};
}

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
