// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "math/vec.h"
#include "optics/camera.h"
#include "optics/light.h"
#include "optics/surface.h"

namespace gischt {

class Medium;  // optics/medium.h
struct Frame;  // grid/frame.h

// The cameras half a frame before and after a view's time.
struct FrameCameras {
    Camera before, after;
    double interval = 0;  // s between them
};

// All that a render method is given: what there is to see at one moment, and from where. The size
// of the picture is the camera's. Cheap to copy: media, lights and frames are shared.
struct View {
    Camera camera;
    std::vector<std::shared_ptr<const Medium>> media;
    std::vector<LightPtr> lights;
    SurfaceSet surfaces;
    // The media at the middles of equal parts of the shutter's time: moving_media[part][i] for
    // media[i], which is that of the middle part. Empty where none moves.
    std::vector<std::vector<std::shared_ptr<const Medium>>> moving_media;
    // What a camera ray sees that meets nothing, W/(m^2 sr), in place of the lights at infinity.
    // Unset: those lights, as far as they are visible to the camera.
    std::optional<Vec3f> background;
    // What lies behind the first of the media, one each: for velocities, and for methods that show
    // the fields themselves (render/field), which need no media.
    std::vector<std::shared_ptr<const Frame>> frames;
    std::optional<FrameCameras> around;  // for motion in pixels per frame

    int frame = 1;
    double time = 0;     // s, the moment at which camera, lights and surfaces were taken
    double shutter = 0;  // s that the film is exposed, centred on time; 0: no motion blur

    int width() const { return camera.width(); }
    int height() const { return camera.height(); }
};

struct BackgroundSample {
    Vec3f radiance;   // W/(m^2 sr)
    float alpha = 0;  // 1 where the picture has a background, else 0
};

// How far the picture of a point moves that is at `before` and `after` when the two cameras are
// taken, in pixels, x to the right and y down. 0 where one of them does not see it.
Vec2f picture_motion(const FrameCameras& around, const Vec3d& before, const Vec3d& after);

// What a camera ray in this direction sees that meets nothing.
BackgroundSample background(const View& view, const Vec3d& direction);

}  // namespace gischt
