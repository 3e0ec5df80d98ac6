// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "solve/multigrid.h"
#include "solve/pockets.h"
#include "solve/poisson.h"

namespace gischt {

// Conjugate gradients (Hestenes & Stiefel 1952) on a stencil operator with one V-cycle as
// preconditioner. Vectors are float, as x is, and sums double: the residual that the iteration
// carries along falls as if in exact arithmetic, the true one of the float x does not fall below
// about 1e-7 max|x| / max|b|.
class StencilSolver {
  public:
    explicit StencilSolver(const StencilSpec& spec);

    SolveResult solve(const TileField<float>& b, TileField<float>& x, double tolerance,
                      int max_iterations, Job& job);

    const Multigrid& multigrid() const { return multigrid_; }
    double bytes_per_cell_iteration() const;

  private:
    // r = b - A x without the means of the pockets, and red z = d r; returns max|b|.
    double start(const TileField<float>& b, TileField<float>& x);
    // Zeroes what lies beyond the box, and gives pockets zero mean.
    void finish(TileField<float>& x) const;

    Multigrid multigrid_;
    Pockets pockets_;
    SplitField r_, p_, z_;
    std::vector<double> sums_;
    std::vector<float> largest_;
};

}  // namespace gischt
