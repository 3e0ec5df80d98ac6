// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "schema/table.h"

namespace gischt {

// How the light of a zonal picture is brought to equilibrium.
enum class ZonalSolver {
    Auto,      // a matrix where it fits into memory_limit, else sweeps
    Exchange,  // a matrix of exchange factors, Gauss-Seidel relaxation
    Sweeps,    // no matrix: conjugate gradients that follow the lines anew in each step
    Ordinates  // discrete ordinates: scattering by the phase function, not evenly
};

// The parameters of the zonal method.
struct ZonalParams {
    int zones = 24;  // along the longest edge
    ZonalSolver solver = ZonalSolver::Auto;
    std::int64_t memory_limit = 64;  // MB of a matrix
    int lines = 16;                  // from each zone's face at the sides
    int light_samples = 32;          // points per zone and directions per light
    int ordinates = 8;               // cosines; twice as many angles around each
    double tolerance = 1e-5;
    int iterations = 500;
    double thickness = 2;  // largest optical thickness of a zone
    bool surfaces = false;
    double step = 1, step_depth = 0.5;
};

const Table<ZonalParams>& zonal_table();

}  // namespace gischt
