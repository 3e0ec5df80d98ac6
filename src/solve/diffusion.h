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

// Solids in a scalar. Null: none of that kind.
struct ScalarSolids {
    const FaceField* fraction =
        nullptr;  // open fractions of the faces; what is closed is insulated
    // Solids that hold a value: signed distance to them at the cells' centres, in any unit,
    // negative inside, true where a surface passes between two neighbours; and the value at both of
    // these.
    const TileField<float>* distance = nullptr;
    const TileField<float>* value = nullptr;  // null: zero
};

// Solids in a velocity. With `fraction` alone they let the fluid slip: faces with fraction 0 lie in
// them, keep their value, and are not felt. With `distance`, signed distances at the faces as
// above, the fluid sticks: what lies inside keeps its value, and `wall` is the solid's velocity on
// both sides of its surface (null: at rest); `fraction` is not read then.
struct VelocitySolids {
    const FaceField* fraction = nullptr;
    const FaceField* distance = nullptr;
    const FaceField* wall = nullptr;
};

// One step of backward Euler (Stam 1999): replaces x by the solution of (1 - number lap) x' = x,
// with the 5- or 7-point Laplacian of unit spacing; number = nu dt / h^2, any size >= 0, is
// dimensionless. Conjugate gradients with a multigrid preconditioner that is as deep as the number
// demands, so that the time is proportional to the cells for every number. Throws Error{Usage} for
// a negative number, and where only one of two opposite sides is periodic. Same bits on any number
// of threads.
//
// Surfaces that hold a value are resolved below a cell: a link to a neighbour inside, whose surface
// lies at the share theta of the way, counts 1 / theta and holds the value (Gibou, Fedkiw, Cheng,
// Kang 2002), which keeps the system symmetric and the solution of second order. theta is at least
// 0.01, so that a value is held off its place by that share of a cell.
//
// A scalar at cell centres. Cells without an open face keep their value.
SolveResult diffuse(TileField<float>& x, double number, const ScalarSides& sides,
                    const ScalarSolids& solids, const SolveLimits& limits, Job& job);
inline SolveResult diffuse(TileField<float>& x, double number, const ScalarSides& sides,
                           const FaceField* fraction, const SolveLimits& limits, Job& job) {
    return diffuse(x, number, sides, ScalarSolids{fraction, nullptr, nullptr}, limits, job);
}

// Every component of a staggered velocity, each on its own. The result holds the largest iteration
// count and residual of the components.
SolveResult diffuse(FaceField& u, double number, const VelocitySides& sides,
                    const VelocitySolids& solids, const SolveLimits& limits, Job& job);

}  // namespace gischt
