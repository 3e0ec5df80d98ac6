// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/probes/probe.h"

namespace gischt {

// A smoke simulation as a source of frames: as many steps per frame as the CFL number asks for.
class SmokeSource final : public FluidSource {
  public:
    SmokeSource(const SmokeParams& params, const FluidWorld& world);

    Frame frame(int number, Job& job) override;
    FrameStatistics statistics() const override { return statistics_; }
    bool is_sequential() const override { return true; }
    bool set_hand(const std::vector<EmitterParams>& hand) override {
        solver_.set_hand(hand);
        return true;
    }
    bool set_probes(const std::vector<ProbeParams>& probes) override;
    std::vector<std::vector<ProbeRow>> take_probe_rows() override { return probes_.take(); }
    void save_state(const std::filesystem::path& path) const override;
    void load_state(const std::filesystem::path& path) override;
    int last_frame() const override { return frame_; }
    Box3d bounds() const override;

    // For initial conditions that no parameter gives; before the first frame.
    SmokeSolver& solver() { return solver_; }
    const SmokeSolver& solver() const { return solver_; }

  private:
    void advance_frame(Job& job);
    void check_whole() const;

    SmokeSolver solver_;
    int frame_ = 0;
    bool is_broken_ = false;  // stopped in the middle of a step
    FrameStatistics statistics_;
    std::optional<double> kinetic_energy_;  // J, of the frame before; none where it is not known
    Probes probes_;
};

}  // namespace gischt
