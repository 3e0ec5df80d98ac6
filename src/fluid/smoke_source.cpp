// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke_source.h"

#include <fmt/format.h>

#include <cmath>

#include "fluid/smoke_frame.h"
#include "fluid/smoke_state.h"

namespace gischt {

// J, as the projection sums it up.
static double kinetic_energy_of(const SmokeSolver& solver) {
    const Domain& d = solver.domain();
    const bool has_solids = !solver.solids().is_empty();
    const double squares = parallel_sum(solver.blocks().size(), 1, [&](int block) {
        double sum = 0;
        for (int a = 0; a < d.axes(); ++a) {
            for_cells(d.faces_of(solver.blocks().cells(block), a), [&](const Vec3i& f) {
                const double u = solver.state().velocity.get(a, f);
                sum += (has_solids ? solver.solids().fraction().get(a, f) : 1.0) * u * u;
            });
        }
        return sum;
    });
    return 0.5 * solver.params().reference_density * d.cell_volume() * squares;
}

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

bool SmokeSource::set_probes(const std::vector<ProbeParams>& probes) {
    probes_ = Probes(probes, solver_);
    if (frame_ == 0) probes_.note(solver_, true);
    return true;
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
    solver_.restart_ledger();
    const double energy_before = kinetic_energy_ ? *kinetic_energy_ : kinetic_energy_of(solver_);
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
        const bool ends_frame = steps == 1;
        probes_.note(solver_, ends_frame);
        if (ends_frame) break;
    }
    frame_ += 1;
    s.kinetic_energy_change = s.kinetic_energy - energy_before;
    kinetic_energy_ = s.kinetic_energy;
    s.density_ledger = solver_.ledger().density();
    s.heat_ledger = solver_.ledger().heat();
    s.mass_per_volume = p.reference_density;
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
    kinetic_energy_.reset();
    statistics_ = {};
    statistics_.frame = frame;
    statistics_.time = solver_.state().time;
}

Box3d SmokeSource::bounds() const {
    const Domain& d = solver_.domain();
    return {d.origin, d.origin + d.h * Vec3d(d.cells)};
}

}  // namespace gischt
