// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "fluid/smoke.h"

namespace gischt {

// Heat that is conducted into the fluid through one side of the domain, with the differences of the
// solver itself: alpha (T_wall - T_cell) / (h/2) where the wall is held at a temperature, alpha
// (T_ambient - T_cell) / h at an open side, whose ambient starts at the next cell's centre; zero
// through insulated walls.
struct SideFlux {
    double total = 0;           // K m^3/s; in 2-D per metre of depth, K m^2/s
    double area = 0;            // m^2; in 2-D m
    std::vector<Vec3d> place;   // centres of the open faces on the side, m
    std::vector<double> local;  // K m/s through each
};
// `wall_temperature` in K; unset: what the domain holds the side at. Throws Error{Usage} for a
// periodic side.
SideFlux measure_side_flux(const SmokeSolver& solver, int axis, int end,
                           const std::optional<double>& wall_temperature);

}  // namespace gischt
