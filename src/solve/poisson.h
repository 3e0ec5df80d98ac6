// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "base/job.h"
#include "grid/field.h"

namespace gischt {

// What lies beyond one side of the box, for the unknown x of a Poisson problem.
enum class Side {
    Wall,      // no flux through the side (Neumann)
    Open,      // x = 0 at the centre of the cell beyond (Dirichlet)
    Periodic,  // both sides of an axis
};

// One rule per side: -x, +x, -y, +y, -z, +z. In 2-D the last two are ignored.
using Sides = std::array<Side, 6>;

struct SolveResult {
    int iterations = 0;
    double residual = 0;  // max|b - L x| / max|b|
    bool converged = false;
};

// Solves L x = b on a box map by conjugate gradients, preconditioned with one multigrid V-cycle
// (McAdams, Sifakis, Teran 2010), without stored matrices: (L x)_c = sum over the faces f of cell c
// of w_f (x_c - x_n), n being the neighbour over f and w_f the open fraction of the face in [0,1]
// (Batty, Bertails, Bridson 2007). L is dimensionless: b carries h^2. Cells whose faces are all
// closed are left out and keep x = 0. Where no side is open, each connected pocket of cells needs b
// with zero sum; a rest is removed (per pocket) before the solution, and x has zero mean there.
// Same bits on any number of threads.
class PoissonSolver {
  public:
    // `fraction`: face fractions on `map`, or null where all are 1; copied as far as needed. Throws
    // Error{Usage} where only one of two opposite sides is periodic.
    PoissonSolver(TileMap::Ptr map, const Sides& sides, const FaceField* fraction = nullptr);
    ~PoissonSolver();
    PoissonSolver(PoissonSolver&&) noexcept;
    PoissonSolver& operator=(PoissonSolver&&) noexcept;

    // x holds the first guess (warm start) and receives the solution. Stops at residual <=
    // tolerance, and where rounding leaves no way down. About 10 iterations give six digits at
    // every size, with solids that are thicker than a cell; walls of one cell take twice as many.
    // The residual is the one that the iteration carries along; rounding x to float adds to the
    // true one about 1e-6 max|x| / max|b|. Throws Error{Cancelled}. One solution at a time per
    // solver.
    SolveResult solve(const TileField<float>& b, TileField<float>& x, double tolerance,
                      int max_iterations, Job& job);

    // Bytes that one iteration reads and writes per cell, counted; for the benchmark.
    double bytes_per_cell_iteration() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gischt
