// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/realtime/drawer.h"
#include "render/realtime/lit_volume.h"
#include "render/slices/half_angle_planes.h"
#include "render/slices/slices_params.h"

namespace gischt {

// Slices across the half vector between view and light (Kniss, Premoze, Hansen, Shirley, McPherson
// 2003; Ikits, Kniss, Lefohn, Hansen 2004). They come in the order in which the light meets them.
// What it has left is kept in a buffer that is seen from it: each slice takes from that what it
// scatters to the eye, and then dims it. All other light is that of the grid.
class HalfAngleSlices {
  public:
    // The device must outlive it. Throws Error{Usage} for vertex sampling.
    HalfAngleSlices(GlDevice& device, const SlicesParams& params);

    // Of a grid that is not empty: the index of the light that sends most to its media, which the
    // volume must keep apart. Throws Error{Usage} where there is none, for octaves of multiple
    // scattering, and for a light that is too near.
    std::size_t choose_light(const LitGrid& grid);
    // Over what is in the target. Throws Error{Usage} when the eye is too near.
    void draw(const LitVolume& volume, const GlCamera& camera, const DrawOrder& order,
              const OpaqueLayer& opaque, const GlFramebuffer& target);

  private:
    void set_common(const GlProgram& program, const LitVolume& volume,
                    const HalfAnglePlanes& planes) const;

    GlDevice& device_;
    SlicesParams params_;
    GlProgram eye_[2], dim_, mix_;  // eye: without and with surfaces that cut slices
    SeenFrom light_;                // relative to the middle of the box
    GlMatrix projection_{};
    GlFramebuffer buffer_;                   // what the light has left
    std::optional<GlFramebuffer> gathered_;  // radiance and coverage; what is let through
};

}  // namespace gischt
