// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fluid/advect.h"
#include "fluid/solid_field.h"
#include "solve/poisson.h"

namespace gischt {

struct ProjectionResult {
    SolveResult solve;
    double max_divergence_dt = 0;  // largest |sum of fluxes out of a cell| dt / h^3 afterwards
    double square_speed = 0;       // integral of |u|^2, m^5/s^2
};

// Makes velocities divergence-free: subtracts the gradient of a pressure that vanishes outside open
// sides and lets nothing through walls and solids. Solids cut cells by their face fractions (Batty,
// Bertails, Bridson 2007), and push with (1 - fraction) of their own velocity.
class PressureProjection {
  public:
    // The arguments must outlive it.
    PressureProjection(const Domain& domain, const BlockMap& blocks, const SolidField& solids);

    // To be called whenever the solids have changed.
    void update_solids();

    // Projects `velocity`. `potential` is the first guess and the result: dt pressure / (rho h), in
    // m/s. Afterwards `speeds` holds the largest components per block.
    ProjectionResult project(FaceField& velocity, TileField<float>& potential, double dt,
                             double tolerance, int max_iterations, BlockSpeeds& speeds, Job& job);

    // u -= factor (potential(c) - potential(c - 1)) on all faces that are not closed.
    void subtract_gradient(FaceField& velocity, const TileField<float>& potential,
                           float factor) const;

    double bytes_per_cell_iteration() const { return solver_->bytes_per_cell_iteration(); }

  private:
    void flux_sums(const FaceField& velocity, TileField<float>& out) const;
    double subtract_gradient(FaceField& velocity, const TileField<float>& potential, float factor,
                             BlockSpeeds& speeds) const;

    const Domain& domain_;
    const BlockMap& blocks_;
    const SolidField& solids_;
    TileField<float> rhs_;
    std::unique_ptr<PoissonSolver> solver_;
};

}  // namespace gischt
