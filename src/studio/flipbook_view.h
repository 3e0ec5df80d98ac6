// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "base/job.h"
#include "image/image.h"
#include "optics/view.h"
#include "scene/scene.h"

namespace gischt {

// The scene as a sprite shows it: its fluids and bounded media alone before nothing, sharp. Solids,
// fog, air, what the camera sees of the lights, motion blur and depth of field are left out.
Scene sprite_scene(const Scene& scene, Vec2i cell);
// Whether a fluid or medium of the scene glows.
bool has_glow(const Scene& scene);
// Nothing in it shines.
Scene without_glow(const Scene& scene);

// A camera as it is at one moment, without a lens.
CameraParams camera_held_still(const CameraParams& camera, double time);

// Fits an orthographic camera that looks along a direction to all that many views show.
class SpriteFit {
  public:
    SpriteFit(const Vec3d& forward, const Vec3d& up);

    // Widens the frame to what the media of the view show: an optical depth of 0.02, or glow.
    void add(const View& view);
    // `margin` is the free share of the picture on each side. Throws Error{Usage} when nothing was
    // to be seen.
    CameraParams camera(double aspect, double margin) const;

  private:
    Vec3d axis_[3];     // right, up, forward
    Vec3d low_, high_;  // along them, metres
};

// The view under the light of one sun of the irradiance 1 W/m^2, nothing else, without surfaces.
View lit_from(const View& view, const Vec3d& towards);
// The view under no light, without surfaces: what glows.
View unlit(const View& view);

// Unit vectors towards the lights of six-way light maps, in the order of light_sides.
std::array<Vec3d, 6> light_directions(const Camera& camera);

// What the media of the view's pixels are on the mean, weighted by their opacity: A, the opacity of
// the strongest channel; A times Z, the depth along the view axis in metres; A times motion.X and
// motion.Y, in pixels per `frames` frames, x to the right and y down, by the velocities of
// view.frames. 2 x 2 rays per pixel, no noise.
Image trace_motion(const View& view, int frames, Job& job);

}  // namespace gischt
