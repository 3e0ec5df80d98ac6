// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "grid/gather.h"
#include "solve/poisson.h"

namespace gischt {

// When an iterative solution stops: at max|b - A x| <= tolerance max|b|, or after so many
// iterations.
struct SolveLimits {
    double tolerance = 1e-5;
    int max_iterations = 100;
};

// What the sides of a box do to a diffusing scalar. Clamp and Even: insulated. Odd: held at `value`
// on the side itself. Zero: held at `value` at the centre of the cell beyond. Periodic: on both
// sides of an axis. `value` is read for Odd and Zero only. In 2-D the last two are ignored.
struct ScalarSides {
    Borders rule;
    std::array<float, 6> value{};
};

// What the sides of a box do to a diffusing velocity. Even: a free-slip wall. Odd: a no-slip wall
// that moves with `velocity` (tangential components; m/s or any unit of u). Clamp: open, zero
// gradient of all components. Zero: tangential components are `velocity` at the centre of the cell
// beyond. Periodic: on both sides of an axis. Where a side is Even, Odd or Zero the normal
// component on it stays as it is.
struct VelocitySides {
    Borders rule;
    std::array<Vec3f, 6> velocity{};
};

// What a solid does to the velocity along it.
enum class SolidSlip { NoSlip, FreeSlip };

// One step of backward Euler (Stam 1999): replaces x by the solution of (1 - number lap) x' = x,
// with the 5- or 7-point Laplacian of unit spacing; number = nu dt / h^2, any size >= 0, is
// dimensionless. Conjugate gradients with a multigrid preconditioner that is as deep as the number
// demands, so that the time is proportional to the cells for every number. Throws Error{Usage} for
// a negative number, and where only one of two opposite sides is periodic. Same bits on any number
// of threads.
//
// A scalar at cell centres. `fraction`: open fractions of the faces, null where all are 1; what is
// closed is insulated, and cells without an open face keep their value.
SolveResult diffuse(TileField<float>& x, double number, const ScalarSides& sides,
                    const FaceField* fraction, const SolveLimits& limits, Job& job);

// Every component of a staggered velocity, each on its own. Faces with fraction 0 lie in the solid
// and keep their value (the solid's velocity); to NoSlip it is what the fluid beside them feels, to
// FreeSlip fluid faces do not feel them. Solids are resolved to a cell, not below. The result holds
// the largest iteration count and residual of the components.
SolveResult diffuse(FaceField& u, double number, const VelocitySides& sides,
                    const FaceField* fraction, SolidSlip slip, const SolveLimits& limits, Job& job);

}  // namespace gischt
