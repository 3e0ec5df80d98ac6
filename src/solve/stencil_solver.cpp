// SPDX-License-Identifier: Apache-2.0
#include "solve/stencil_solver.h"

#include <algorithm>
#include <cmath>

namespace gischt {
namespace {

double max_of(const std::vector<float>& values) {
    float m = 0;
    for (const float v : values) m = std::max(m, v);
    return static_cast<double>(m);
}

}  // namespace

StencilSolver::StencilSolver(const StencilSpec& spec)
    : multigrid_(spec), pockets_(multigrid_.finest()) {
    const int tiles = multigrid_.finest().tiles_with_ghosts;
    r_ = SplitField(tiles);
    p_ = SplitField(tiles);
    z_ = SplitField(tiles);
    sums_.resize(multigrid_.finest().active.size());
    largest_.resize(sums_.size());
}

double StencilSolver::start(const TileField<float>& b, TileField<float>& x) {
    const StencilLevel& level = multigrid_.finest();
    for_active(level, [&](const TileRange& range) {
        split(range, b.values().data(), r_);
        split(range, x.values().data(), p_);
    });
    // What is left out is zero in p by now, and has to be so in x.
    std::ranges::fill(x.values(), 0.0f);
    pockets_.remove_mean_split(level, r_.data());
    for_active(level, [&](const TileRange& range) { max_magnitude(range, r_, largest_); });
    const double norm = max_of(largest_);

    // x = 0 + 1 p, r = b - 1 A p.
    fill_ghosts(level, p_);
    for_active(level, [&](const TileRange& range) {
        advance(range, 1.0f, p_, x.values().data(), r_, z_, largest_);
    });
    return norm;
}

void StencilSolver::finish(TileField<float>& x) const {
    const StencilLevel& level = multigrid_.finest();
    if (!level.copies.empty()) {
        parallel_for(level.map->size(), 16, [&](int t) {
            const Vec3i size = level.map->cells_of(t).size();
            if (size == level.shape().extent()) return;
            for (int v = 0; v < tile_values; ++v) {
                if (min_component(size - level.shape().cell(v)) <= 0) x.tile(t)[v] = 0;
            }
        });
    }
    pockets_.remove_mean_natural(level, x.values().data());
}

double StencilSolver::bytes_per_cell_iteration() const {
    // What kernels.h counts per sweep: direction 12, multiply_sum 4, advance 24 on the finest
    // level; on each the two first sweeps 8 + 6, transfers 2.5 + 6.5, the sweeps after 8 + 8, and
    // the red first sweep 6 of the coarser level. Own blocks add their 8 values per visited cell.
    constexpr double finest = 40, cycle = 39, first = 6, block = 32;
    constexpr double block_visits_finest = 2 + 0.5, block_visits_cycle = 2;
    double bytes = 0;
    for (const StencilLevel& level : multigrid_.levels()) {
        double own = 0;
        for (const int t : level.active) own += level.is_own(t) ? 1 : 0;
        const double tiles = static_cast<double>(level.active.size());
        bytes += tiles * (cycle + (level.depth == 0 ? finest : first)) +
                 own * block * (block_visits_cycle + (level.depth == 0 ? block_visits_finest : 0));
    }
    const double cells = static_cast<double>(volume(multigrid_.finest().cells));
    return bytes * tile_values / cells;
}

SolveResult StencilSolver::solve(const TileField<float>& b, TileField<float>& x, double tolerance,
                                 int max_iterations, Job& job) {
    const StencilLevel& level = multigrid_.finest();
    SolveResult result;
    const double norm = start(b, x);
    if (!(norm > 0)) {
        std::ranges::fill(x.values(), 0.0f);
        result.converged = true;
        return result;
    }
    double rho = 0;
    result.residual = max_of(largest_) / norm;
    while (result.residual > tolerance && result.iterations < max_iterations) {
        job.check();
        const double rho_before = rho;
        rho = multigrid_.precondition(r_, z_);
        const double beta = rho_before > 0 ? rho / rho_before : 0;
        for_active(level, [&](const TileRange& range) {
            direction(range, static_cast<float>(beta), z_, p_);
        });
        fill_ghosts(level, p_);
        for_active(level, [&](const TileRange& range) { multiply_sum(range, p_, sums_); });
        const double curvature = tree_sum(sums_);
        // Both are positive until the residual drowns in rounding.
        if (!(rho > 0 && curvature > 0)) break;
        const auto step = static_cast<float>(rho / curvature);
        for_active(level, [&](const TileRange& range) {
            advance(range, step, p_, x.values().data(), r_, z_, largest_);
        });
        result.residual = max_of(largest_) / norm;
        ++result.iterations;
    }
    result.converged = result.residual <= tolerance;
    finish(x);
    return result;
}

}  // namespace gischt
