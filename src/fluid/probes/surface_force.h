// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/smoke.h"

namespace gischt {

// What the fluid does to a solid; in 2-D per metre of depth (N/m, N).
struct SolidForce {
    Vec3d pressure;  // N
    Vec3d viscous;   // N
    Vec3d torque;    // N m, of both, about the solid's position

    Vec3d total() const { return pressure + viscous; }
};

// The force on a solid of the solver's world. In 3-D each cell holds the part of the surface whose
// vector area closes the open parts of its faces, and its own pressure acts on that: a linear
// pressure gives Archimedes' force on the volume that the fractions enclose. In 2-D a chord crosses
// each cell, and the pressure on its middle is fitted to that of the cells around. The viscous
// traction mu (grad u + grad u^T) n takes its gradient from a quadratic fitted to the velocities
// within 2.5 cells in the fluid, which has the solid's velocity on the surface. Both are of second
// order; the traction is that of a fluid that sticks to the solid. A surface on a side of the
// domain does not count; the pressure is relative to the ambient, which matters for solids that the
// domain cuts. Throws Error{Usage} where `solid` is none of the world's.
SolidForce measure_solid_force(const SmokeSolver& solver, std::size_t solid, bool viscous);

}  // namespace gischt
