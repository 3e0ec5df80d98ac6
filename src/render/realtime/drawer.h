// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "render/method.h"
#include "render/realtime/gl_camera.h"
#include "render/realtime/opaque_layer.h"

namespace gischt {

// One picture to be drawn.
struct DrawOrder {
    Camera camera;
    Vec2d shift;         // in pixels, as in GlCamera
    float phase = 0.5f;  // in [0,1): moves what a method samples at regular distances
    // In place of radiance and coverage, draws (sum of opacity times depth along the view axis, 0,
    // 0, sum of opacity).
    bool as_depth = false;
};

// The part of a method that speaks OpenGL, for files and windows alike: it takes a view once and
// draws it for any camera into any framebuffer. Colours are linear radiance, premultiplied by
// coverage; who shows them applies exposure and tone curve.
class SceneDrawer {
  public:
    virtual ~SceneDrawer() = default;
    // Keeps what holds still. Throws Error{Usage} when the method cannot show this view.
    virtual void upload(const View& view, Job& job) = 0;
    // Draws over what `opaque` holds for that camera, which is drawn first. The target has the
    // size of the camera's picture.
    virtual void draw(const DrawOrder& order, const OpaqueLayer& opaque,
                      const GlFramebuffer& target) = 0;
    // The light of the view, for the opaque layer.
    virtual const LitGrid& grid() const = 0;
};

// Makes a whole picture: the mean over samples_per_pixel pictures that differ in the points of the
// pixels and in DrawOrder::phase, and reads it back. Throws Error{Usage} for a depth other than 1,
// for layers, and for a part of a film.
RenderResult draw_to_image(std::string_view method, SceneDrawer& drawer, const View& view,
                           const RenderSettings& settings, Job& job);

}  // namespace gischt
