// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "fluid/particles/particle_system.h"
#include "fluid/particles/splat.h"

namespace gischt {

// What a particle system needs from elsewhere.
struct ParticleInputs {
    std::vector<Mesh> meshes;  // one per source, empty where that is no mesh
    // Frames of the fluid whose motion carries the particles, asked for in ascending order and
    // maybe one twice; none: the air has only its own motion.
    std::function<std::shared_ptr<const Frame>(int number, Job& job)> flow;
};

// A particle system as a source of frames: the particles under the name `particles`, and the fields
// that splat_particles() makes of them.
class ParticleSource final : public FluidSource {
  public:
    ParticleSource(const ParticleParams& params, const FluidWorld& world,
                   ParticleInputs inputs = {});

    Frame frame(int number, Job& job) override;
    FrameStatistics statistics() const override { return statistics_; }
    bool is_sequential() const override { return true; }
    void save_state(const std::filesystem::path& path) const override;
    void load_state(const std::filesystem::path& path) override;
    int last_frame() const override { return frame_; }
    Box3d bounds() const override;

    const ParticleSystem& system() const { return system_; }

  private:
    void advance_frame(Job& job);
    std::shared_ptr<const Flow> flow_at(int number, Job& job) const;
    Frame make_frame(Job& job);
    void check_whole() const;

    ParticleSystem system_;
    ParticleInputs inputs_;
    double fps_;
    int frame_ = 0;
    bool is_broken_ = false;  // stopped in the middle of a frame
    int flow_number_ = -1;    // frame of flow_
    std::shared_ptr<const Flow> flow_;
    FrameStatistics statistics_;
};

// The cells in which the particles of a domain become a density.
SplatLattice splat_lattice(const ParticleDomain& domain);

}  // namespace gischt
