// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/march/irradiance_map.h"
#include "render/realtime/gl_camera.h"
#include "render/realtime/lit_grid.h"

namespace gischt {

// What lies behind all that is drawn by graphics hardware: the surfaces of a view, lit by its
// lights through the smoke and shadowing each other, and where there is none the background. Made
// pixel by pixel by the processor, since surfaces are what SurfaceSet says they are.
struct OpaqueImage {
    int width = 0, height = 0;
    std::vector<float> radiance;  // premultiplied RGBA, rows from bottom to top
    std::vector<float> depth;     // along the view axis, metres; infinity where nothing is hit
    bool has_surfaces = false;
};

// `shift` as in GlCamera. `u` in [0,1)^2 chooses the point of a sun's disc. Light of the sky is not
// shadowed by surfaces.
class OpaquePainter {
  public:
    // Takes some 20 ms for each light from all of the sky. The view and grid must outlive it.
    OpaquePainter(const View& view, const LitGrid& grid);
    OpaqueImage paint(const Camera& camera, Vec2d shift, Vec2f u, Job& job) const;

  private:
    Vec3f shade(const SurfaceHit& hit, Vec2f u) const;

    const View& view_;
    const LitGrid& grid_;
    std::vector<IrradianceMap> open_sky_;
};

// That image on the device, to be drawn first.
class OpaqueLayer {
  public:
    explicit OpaqueLayer(GlDevice& device);

    void upload(const OpaqueImage& image);
    // Fills colour and depth of the target that is bound. With `as_depth` the colour becomes
    // (z, 0, 0, 1), and all zero where nothing is hit.
    void draw(const GlCamera& camera, bool as_depth) const;
    bool has_surfaces() const { return has_surfaces_; }
    // Depth along the view axis in metres, as floats; 1e30 where nothing is.
    const GlTexture& depth() const { return depth_; }

  private:
    GlDevice& device_;
    GlProgram program_;
    GlTexture radiance_, depth_;
    bool has_surfaces_ = false;
};

}  // namespace gischt
