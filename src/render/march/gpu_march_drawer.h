// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/march/gpu_march_params.h"
#include "render/realtime/drawer.h"
#include "render/realtime/lit_volume.h"

namespace gischt {

// Draws media by following the ray of every pixel through the grid: eq. 19 front to back, the light
// of each cell being known. Blocks of cells without anything in them are crossed in one step.
class GpuMarchDrawer : public SceneDrawer {
  public:
    // The device must outlive it.
    GpuMarchDrawer(GlDevice& device, const GpuMarchParams& params);

    void upload(const View& view, Job& job) override;
    void draw(const DrawOrder& order, const OpaqueLayer& opaque,
              const GlFramebuffer& target) override;
    const LitGrid& grid() const override { return *grid_; }

  private:
    GlDevice& device_;
    GpuMarchParams params_;
    GlProgram grey_, colored_;
    LitVolume volume_;
    std::optional<LitGrid> grid_;
};

}  // namespace gischt
