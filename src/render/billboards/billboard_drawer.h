// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/billboards/billboards_params.h"

namespace gischt {

// Draws particles as squares with pictures on them.
class BillboardDrawer : public SceneDrawer {
  public:
    // The device must outlive it.
    BillboardDrawer(GlDevice& device, const BillboardsParams& params);

    void upload(const View& view, Job& job) override;
    void draw(const DrawOrder& order, const OpaqueLayer& opaque,
              const GlFramebuffer& target) override;
    const LitGrid& grid() const override { return stage_.grid(); }

  private:
    GlDevice& device_;
    BillboardsParams params_;
    GlProgram squares_[2], points_[2];  // without and with surfaces to fade before
    ParticleStage stage_;
    GlTexture sprites_;
    GlBuffer corners_;
    bool is_sequence_ = true, is_round_ = false;
};

// GLSL: billboard_edges(center, velocity, turn, right, up), the two unit vectors along the edges of
// a square by its `facing` (0 camera, 1 velocity, 2 fixed across `fixed_normal`). The normal is
// their cross product, and points to the viewer.
extern const char* const billboard_glsl;

}  // namespace gischt
