// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke_source.h"

#include <fmt/format.h>

#include <cmath>

#include "fluid/smoke_frame.h"
#include "fluid/smoke_state.h"

namespace gischt {

SmokeSource::SmokeSource(const SmokeParams& params, const FluidWorld& world)
    : solver_(params, world) {}

Frame SmokeSource::frame(int number, Job& job) {
    if (number < frame_) {
        throw Error(
            ErrorKind::Usage, "smoke",
            fmt::format("frame {} lies before frame {}, where the simulation is", number, frame_),
            "a simulation runs forward: load a state or start again");
    }
    check_whole();
    while (frame_ < number) {
        is_broken_ = true;
        advance_frame(job);
        is_broken_ = false;
    }
    return make_frame(solver_, number);
}

void SmokeSource::check_whole() const {
    if (!is_broken_) return;
    throw Error(ErrorKind::Usage, "smoke", "the simulation was stopped in the middle of a step",
                "load a state or start again");
}

// Steps of equal length to the end of the frame, found anew after each, since speeds change.
void SmokeSource::advance_frame(Job& job) {
    const double begin = now_seconds();
    const SmokeParams& p = solver_.params();
    const double end = (frame_ + 1) / solver_.world().fps;
    FrameStatistics s;
    bool warned = false;
    while (s.steps < p.max_substeps) {
        const double rest = end - solver_.state().time;
        const double wanted = rest / solver_.longest_step();
        const int allowed = p.max_substeps - s.steps, least = std::max(p.min_substeps - s.steps, 1);
        // The last bits of times must not cost a step.
        const double count = std::max(std::ceil(wanted * (1 - 1e-9)), static_cast<double>(least));
        if (count > allowed && !warned) {
            warned = true;
            job.warn(
                fmt::format("frame {}: {:.0f} more steps wanted for cfl = {}, max_substeps "
                            "allows {}: the motion is coarser than asked for",
                            frame_ + 1, count, p.cfl, allowed));
        }
        const int steps = static_cast<int>(std::min(count, static_cast<double>(allowed)));
        job.progress(std::clamp(1 - rest * solver_.world().fps, 0.0, 1.0), "simulate");
        const StepStatistics step = solver_.step(rest / steps, job);
        s.steps += 1;
        s.pressure_iterations += step.solve.iterations;
        s.pressure_residual = std::max(s.pressure_residual, step.solve.residual);
        s.max_divergence_dt = std::max(s.max_divergence_dt, step.max_divergence_dt);
        s.kinetic_energy = step.kinetic_energy;
        s.max_speed = step.max_speed;
        if (steps == 1) break;
    }
    frame_ += 1;
    s.frame = frame_;
    s.time = solver_.state().time;
    s.mass = p.reference_density * solver_.density_integral();
    s.cells = static_cast<std::int64_t>(volume(solver_.domain().cells));
    s.active_tiles = count_active_tiles(solver_);
    s.wall_seconds = now_seconds() - begin;
    statistics_ = s;
}

void SmokeSource::save_state(const std::filesystem::path& path) const {
    check_whole();
    save_smoke_state(solver_.state(), frame_, path);
}

void SmokeSource::load_state(const std::filesystem::path& path) {
    int frame = 0;
    SmokeState state = load_smoke_state(solver_.domain(), solver_.blocks(), path, frame);
    solver_.set_state(std::move(state));
    frame_ = frame;
    is_broken_ = false;
    statistics_ = {};
    statistics_.frame = frame;
    statistics_.time = solver_.state().time;
}

Box3d SmokeSource::bounds() const {
    const Domain& d = solver_.domain();
    return {d.origin, d.origin + d.h * Vec3d(d.cells)};
}

}  // namespace gischt
