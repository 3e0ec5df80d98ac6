// SPDX-License-Identifier: Apache-2.0
// Solvers whose state is an analytic field, for tests of probes.
#pragma once

#include <functional>

#include "fluid/smoke.h"

namespace gischt {

// The unit square or cube, still and without gravity.
inline SmokeParams unit_domain(int resolution, bool is_2d, SideKind sides = SideKind::FreeSlip) {
    SmokeParams p;
    p.domain.resolution = resolution;
    p.domain.max = {1, 1, is_2d ? 0.0 : 1.0};
    p.domain.set_all_sides(sides);
    return p;
}

inline FluidWorld still_world() {
    FluidWorld world;
    world.gravity = {};
    return world;
}

using VectorOfPoint = std::function<Vec3d(const Vec3d&)>;
using ScalarOfPoint = std::function<double(const Vec3d&)>;

// Sets the pressure in Pa at the cells' centres, those in solids among them.
inline void set_pressure(SmokeSolver& solver, const ScalarOfPoint& pressure) {
    SmokeState state = solver.state();
    state.potential_dt = 0.01;
    const double unit =
        state.potential_dt / (solver.params().reference_density * solver.domain().h);
    for_cells(Box3i{{}, solver.domain().cells}, [&](const Vec3i& c) {
        state.potential.ref(c) = static_cast<float>(unit * pressure(solver.domain().center_of(c)));
    });
    solver.set_state(std::move(state));
}

inline void set_velocity(SmokeSolver& solver, const VectorOfPoint& velocity) {
    Job job;
    solver.fill(
        {.velocity = velocity, .density = nullptr, .temperature = nullptr, .project = false}, job);
}

inline void set_scalars(SmokeSolver& solver, const ScalarOfPoint& density,
                        const ScalarOfPoint& temperature) {
    Job job;
    solver.fill(
        {.velocity = nullptr, .density = density, .temperature = temperature, .project = false},
        job);
}

}  // namespace gischt
