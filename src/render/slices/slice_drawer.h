// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "render/realtime/drawer.h"
#include "render/realtime/lit_volume.h"
#include "render/slices/half_angle.h"

namespace gischt {

// Draws media as three stacks of slices, or as slices across the half vector.
class SliceDrawer : public SceneDrawer {
  public:
    // The device must outlive it. Throws Error{Usage} for parameters that contradict each other.
    SliceDrawer(GlDevice& device, const SlicesParams& params);

    void upload(const View& view, Job& job) override;
    void draw(const DrawOrder& order, const OpaqueLayer& opaque,
              const GlFramebuffer& target) override;
    const LitGrid& grid() const override { return *grid_; }
    const LitVolume& light() const { return volume_; }

  private:
    void draw_stack(int axis, const GlCamera& camera, const DrawOrder& order,
                    const OpaqueLayer& opaque);
    void mix(const GlFramebuffer& stack, double share, bool is_first, const GlFramebuffer& target);

    GlDevice& device_;
    SlicesParams params_;
    GlProgram grey_[2], colored_[2], mix_;  // without and with surfaces that cut slices
    LitVolume volume_;
    std::unique_ptr<HalfAngleSlices> half_angle_;  // only of that kind
    std::optional<LitGrid> grid_;
    std::optional<GlFramebuffer> scratch_;
};

}  // namespace gischt
