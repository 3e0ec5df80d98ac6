// SPDX-License-Identifier: Apache-2.0
#include "solve/diffusion_step.h"

#include <cmath>

#include "base/parallel.h"

namespace gischt {
namespace {

// Every coarser level divides the number by 4. Below a quarter the identity outweighs the
// Laplacian, and Gauss-Seidel alone gains a digit per iteration.
int levels_for(double number) {
    const double excess = number / 0.25;
    return excess <= 1 ? 1 : 1 + static_cast<int>(std::ceil(std::log2(excess) / 2));
}

}  // namespace

DiffusionStep::DiffusionStep(StencilSpec spec, double number)
    : spec_(std::move(spec)), number_(number) {
    if (!(number >= 0)) {
        throw Error(ErrorKind::Usage, "diffusion", "the diffusion number is negative or no number",
                    "viscosity and time step have to be positive");
    }
    if (is_identity()) return;
    spec_.shift = 1 / number;
    spec_.max_levels = levels_for(number);
    b_ = TileField<float>(spec_.map);
}

void DiffusionStep::set_right_hand_side(const TileField<float>& x) {
    const auto scale = static_cast<float>(spec_.shift);
    parallel_for(x.map().size(), 64, [&](int t) {
        for (int v = 0; v < tile_values; ++v) b_.tile(t)[v] = scale * x.tile(t)[v];
    });
}

SolveResult DiffusionStep::solve(TileField<float>& x, const SolveLimits& limits, Job& job) {
    StencilSolver solver(spec_);
    return solver.solve(b_, x, limits.tolerance, limits.max_iterations, job);
}

}  // namespace gischt
