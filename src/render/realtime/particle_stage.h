// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/realtime/blending.h"
#include "render/realtime/drawer.h"
#include "render/realtime/particle_cloud.h"

namespace gischt {

enum class ParticleOrder {
    Sorted,    // the farthest first, by the device
    Unsorted,  // as they come, depth being tested and not written: right for additive blending
};

// What points and billboards share.
struct ParticleDrawParams {
    GridParams grid;
    ParticleShadingParams shading;
    BlendParams blend;
    ParticleOrder order = ParticleOrder::Sorted;
};

// All keys; those of GridParams among them.
const Table<ParticleDrawParams>& particle_draw_table();

// The particles of a view on the device, lit and in order.
class ParticleStage {
  public:
    // The device and params must outlive it.
    ParticleStage(GlDevice& device, const ParticleDrawParams& params);

    void upload(const View& view, std::string_view method, Job& job);
    const LitGrid& grid() const { return *grid_; }
    const ParticleCloud& cloud() const { return cloud_; }

    GlCamera camera(const DrawOrder& order) const {
        return GlCamera(order.camera, cloud_.origin(), cloud_.reach(), order.shift);
    }
    // Shades and sorts, then binds the buffers: storage 0 places, 1 motions, 2 chances, 3 colours,
    // 4 order.
    void bind(const GlCamera& camera);
    // Blending and depth for the parameters, or those that sum depths.
    GlDraw draw(bool as_depth) const;
    // The uniforms of particle_glsl.
    void set(const GlProgram& program, const GlCamera& camera, const DrawOrder& order) const;

  private:
    bool is_sorted() const;

    GlDevice& device_;
    const ParticleDrawParams& params_;
    ParticleCloud cloud_;
    DepthSort sort_;
    GlBuffer identity_;
    std::optional<LitGrid> grid_;
    std::vector<std::shared_ptr<const Frame>> frames_;  // whose particles these are
};

// GLSL of vertex stages: the buffers, and particle_at(i), the index of the i-th in order.
extern const char* const particle_glsl;
// GLSL of fragment stages: emit(radiance, alpha, z) writes what the blending expects.
extern const char* const particle_fragment_glsl;

}  // namespace gischt
