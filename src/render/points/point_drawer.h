// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/points/points_params.h"

namespace gischt {

// Draws particles as discs that face the camera, flat and of one colour.
class PointDrawer : public SceneDrawer {
  public:
    // The device must outlive it.
    PointDrawer(GlDevice& device, const PointsParams& params);

    void upload(const View& view, Job& job) override { stage_.upload(view, "points", job); }
    void draw(const DrawOrder& order, const OpaqueLayer& opaque,
              const GlFramebuffer& target) override;
    const LitGrid& grid() const override { return stage_.grid(); }

  private:
    GlDevice& device_;
    PointsParams params_;
    GlProgram program_;
    ParticleStage stage_;
};

}  // namespace gischt
