// SPDX-License-Identifier: Apache-2.0
#include "fluid/sides.h"
#include "fluid/smoke.h"

namespace gischt {

// A step of second order. What changes the velocity along the path of the fluid,
//
//     du/dt = G,  G = f + nu lap u - grad p / rho,
//
// is integrated by the trapezoidal rule along that path: half of dt G is added where the fluid
// comes from, half where it arrives (Xiu, Karniadakis 2001; as in weather models: Robert 1981). The
// path is traced by Runge-Kutta of third order through the velocity in the middle of the step,
// extrapolated from the last two, and what is carried is interpolated by cubics.
//
// The pressure is that of the middle of the step. At the beginning the last step's is taken; the
// projection at the end adds what is missing. Both halves together make the reflection of Zehnder,
// Narain, Thomaszewski 2018 (the carried velocity is as far on the other side of the
// divergence-free ones as the advected one will be), with one projection per step. Viscosity acts
// on a velocity that has felt the last pressure, so that walls hold it to second order (Van Kan
// 1986), and a flow at rest in time does not depend on dt.
//
// The first step is made twice: once of first order, all at its end, to find what a step before it
// would have left, and then as any other.
namespace {

// out = a x + b y, upper faces included.
void combine(float a, const FaceField& x, float b, const FaceField& y, FaceField& out) {
    for (int axis = 0; axis < x.axes(); ++axis) {
        const auto s = static_cast<std::size_t>(axis);
        const auto mix = [&](const AlignedVector<float>& p, const AlignedVector<float>& q,
                             AlignedVector<float>& r) {
            parallel_ranges(static_cast<int>(r.size() / 16 + 1), 1024, [&](int begin, int end) {
                const std::size_t stop = std::min(static_cast<std::size_t>(end) * 16, r.size());
                for (std::size_t i = static_cast<std::size_t>(begin) * 16; i < stop; ++i) {
                    r[i] = a * p[i] + b * q[i];
                }
            });
        };
        mix(x[axis].values(), y[axis].values(), out[axis].values());
        mix(x.last[s], y.last[s], out.last[s]);
    }
}

// x += a y.
void add(TileField<float>& x, float a, const TileField<float>& y) {
    parallel_for(x.map().size(), 64, [&](int t) {
        float* to = x.tile(t);
        const float* from = y.tile(t);
        for (int i = 0; i < tile_values; ++i) to[i] += a * from[i];
    });
}

}  // namespace

ProjectionResult SmokeSolver::step_high(double dt, Job& job) {
    if (state_.history.dt == 0) {
        SmokeState start = state_;
        advance_high(dt, job);
        // Backwards from the start as far as the trial went forwards.
        combine(2, start.velocity, -1, state_.velocity, state_.history.previous);
        start.history = std::move(state_.history);
        start.potential = std::move(state_.potential);
        start.potential_dt = dt;
        state_ = std::move(start);
        restart_ledger();
        ledger_.begin_step(scalars(), state_.velocity, dt);
        if (solids_.update(state_.time)) projection_.update_solids();
    }
    return advance_high(dt, job);
}

ProjectionResult SmokeSolver::advance_high(double dt, Job& job) {
    SmokeHistory& history = state_.history;
    const bool is_first = history.dt == 0;
    const double share = is_first ? 1 : 0.5;  // of dt G that acts at the end of the step
    const double time = state_.time + dt;
    {
        const PhaseTimer timer(job, "advect");
        advect_high(dt, job);
    }
    job.check();
    meet_solids_and_sources(time, dt, job);
    slow_inflow(domain_, dt, state_.velocity);
    history.kick = state_.velocity;
    diffuse_scalars(share * dt, &history, job);
    push(time, share * dt, job);

    scale_potential(dt);
    if (is_first) std::ranges::fill(state_.potential.values(), 0.0f);
    potential_before_ = state_.potential;
    projection_.subtract_gradient(state_.velocity, potential_before_, 0.5f);
    diffuse_velocity(share * dt, job);
    projection_.subtract_gradient(state_.velocity, potential_before_, -0.5f);
    job.check();
    // What acts at the end: half the old potential and what is added to it.
    add(state_.potential, -0.5f, potential_before_);
    const ProjectionResult result = project(dt, job);

    // Half of dt G: the change since advection, but with half of the new potential.
    combine(1, state_.velocity, -1, history.kick, history.kick);
    if (is_first) {
        combine(0.5f, history.kick, 0, history.kick, history.kick);
        for (auto* kick : {&history.density_kick, &history.temperature_kick}) {
            for (float& k : kick->values()) k *= 0.5f;
        }
    } else {
        add(state_.potential, 0.5f, potential_before_);
        // Added potential phi = new - old, of which half belongs to the step's other end.
        add(potential_before_, -1, state_.potential);
        projection_.subtract_gradient(history.kick, potential_before_, 0.5f);
    }
    history.dt = dt;
    return result;
}

// Adds the first half of dt G, and carries.
void SmokeSolver::advect_high(double dt, Job& job) {
    SmokeHistory& history = state_.history;
    FaceField& carried = velocity_predicted_;
    if (history.dt == 0) {
        history.previous = state_.velocity;
        carried = state_.velocity;
    } else {
        const auto ratio = static_cast<float>(dt / history.dt);
        combine(1, state_.velocity, ratio, history.kick, carried);
        combine(1 + 0.5f * ratio, state_.velocity, -0.5f * ratio, history.previous,
                history.previous);
        if (!solids_.is_empty()) solids_.extrapolate(carried);
        const auto kick = [&](SparseField& field, const TileField<float>& change) {
            if (change.is_empty()) return;
            add(field.values, ratio, change);
            drop_small(blocks_, field, 0);
        };
        kick(state_.density, history.density_kick);
        kick(state_.temperature, history.temperature_kick);
        note_diffusion(0.5 * dt);
    }
    const FaceField& through = history.previous;
    AdvectedVelocity velocity{&carried, nullptr, &velocity_next_, AdvectionScheme::SemiLagrangian,
                              &through};
    carry(velocity, measure_speeds(domain_, blocks_, through), Interpolation::Cubic, dt, job);
    std::swap(state_.velocity, history.previous);
    std::swap(state_.velocity, carried);
}

}  // namespace gischt
