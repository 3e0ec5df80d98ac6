// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "fluid/forces.h"
#include "fluid/ledger.h"
#include "fluid/project.h"
#include "fluid/smoke_params.h"
#include "fluid/source.h"

namespace gischt {

// What a step of high accuracy hands on to the next.
struct SmokeHistory {
    FaceField previous;  // velocity one step ago, m/s
    // Half of what changes the velocity (a scalar) in a step beside advection, at its end: m/s (1,
    // K). Empty for a scalar that does not diffuse.
    FaceField kick;
    TileField<float> density_kick, temperature_kick;
    double dt = 0;  // of that step, s; 0: there is none
};

// All that a later step depends on. Scalars are deviations from the ambient.
struct SmokeState {
    double time = 0;  // s
    std::int64_t steps = 0;
    FaceField velocity;          // m/s, divergence-free
    TileField<float> potential;  // of the last projection: dt pressure / (rho h), m/s
    double potential_dt = 0;     // its dt, s; 0: no projection yet
    SparseField density;         // 1
    SparseField temperature;     // T - T_ambient, K
    SmokeHistory history;
};

struct StepStatistics {
    SolveResult solve;
    double max_divergence_dt = 0;
    double kinetic_energy = 0;  // J
    double max_speed = 0;       // m/s, largest component
};

// Smoke on a staggered grid by operator splitting (Stam 1999; Fedkiw, Stam, Jensen 2001). A step is
// the cycle advect - decay - sources - diffusion - forces - viscosity - project: Stam's, entered
// such that the state between steps is divergence-free.
class SmokeSolver {
  public:
    // Throws Error{Usage} on impossible parameters.
    SmokeSolver(const SmokeParams& params, const FluidWorld& world);
    SmokeSolver(const SmokeSolver&) = delete;
    SmokeSolver& operator=(const SmokeSolver&) = delete;

    // Advances by dt > 0 seconds. Throws Error{Cancelled}, leaving a state that is good for
    // nothing; Error{Resource} when the pressure does not converge to a finite number.
    StepStatistics step(double dt, Job& job);
    // The longest step that moves nothing further than `cfl` cells: air at the speed that it has,
    // or gains from the present heat and weight, sources and solids.
    double longest_step() const;
    // Further sources from now on, in place of those of the last call: what a hand does to it.
    void set_hand(const std::vector<EmitterParams>& hand);
    // Integral of density over the domain without what lies in solids, m^3.
    double density_integral() const;

    // Sets the state at points in metres; null leaves a quantity. Velocities are projected before
    // they are used when `project` is set.
    struct Initial {
        std::function<Vec3d(const Vec3d&)> velocity;
        std::function<double(const Vec3d&)> density, temperature;  // temperature in K
        bool project = true;
    };
    void fill(const Initial& initial, Job& job);

    const SmokeParams& params() const { return params_; }
    const FluidWorld& world() const { return world_; }
    const Domain& domain() const { return domain_; }
    const BlockMap& blocks() const { return blocks_; }
    const SolidField& solids() const { return solids_; }
    const SmokeState& state() const { return state_; }
    // Continues from another state of the same domain.
    void set_state(SmokeState state);
    // Where smoke and heat came from and went since restart_ledger(), fill() or set_state().
    const Ledger& ledger() const { return ledger_; }
    void restart_ledger() { ledger_.restart(scalars()); }
    double pressure_bytes_per_cell() const { return projection_.bytes_per_cell_iteration(); }

  private:
    void hold_sides(double time);
    bool is_high() const { return params_.accuracy == Accuracy::High; }
    ProjectionResult step_standard(double dt, Job& job);
    void carry(AdvectedVelocity& velocity, const BlockSpeeds& speeds, Interpolation interpolation,
               double dt, Job& job);
    void meet_solids_and_sources(double time, double dt, Job& job);
    // Notes what diffusion changes in `history`, if any.
    void diffuse_scalars(double dt, SmokeHistory* history, Job& job);
    void push(double time, double dt, Job& job);
    void diffuse_velocity(double dt, Job& job);
    void scale_potential(double dt);
    // Of high accuracy, in smoke_second_order.cpp.
    ProjectionResult step_high(double dt, Job& job);
    ProjectionResult advance_high(double dt, Job& job);
    void advect_high(double dt, Job& job);
    Forces forces_at(double time) const;
    ProjectionResult project(double dt, Job& job);
    double thermal_expansion() const;
    Vec3d initial_velocity(const Vec3d& point) const;
    void note_diffusion(double dt) {
        ledger_.note_diffusion(scalars(), {params_.smoke_diffusivity, params_.thermal_diffusivity},
                               dt);
    }
    Ledger::Scalars scalars() const { return {&state_.density, &state_.temperature}; }

    SmokeParams params_;
    FluidWorld world_;
    Domain domain_;
    BlockMap blocks_;
    SolidField solids_;
    Ledger ledger_;
    Emitters emitters_;
    PressureProjection projection_;
    SmokeState state_;
    BlockSpeeds speeds_;
    // What a sweep reads or leaves besides the state.
    FaceField velocity_predicted_, velocity_next_;
    TileField<float> potential_before_;
    SparseField density_predicted_, density_next_, temperature_predicted_, temperature_next_;
};

}  // namespace gischt
