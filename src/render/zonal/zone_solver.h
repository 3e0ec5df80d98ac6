// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "render/zonal/exchange_matrix.h"

namespace gischt {

// How the exchange of light between zones is brought to equilibrium.
enum class ZoneSolver {
    Exchange,  // a matrix of exchange factors, Gauss-Seidel relaxation
    Sweeps,    // no matrix: conjugate gradients, each step of which follows all lines
};

struct ZoneSolveLimits {
    double tolerance = 1e-4;  // of the residual, relative to that of no light, in its own norm
    int most_iterations = 500;
    std::int64_t memory = std::int64_t{1} << 30;  // bytes, of a matrix
};

// Light in equilibrium.
struct ZoneSolution {
    // Mean radiance that arrives at each element, W/(m^2 sr).
    std::vector<Vec3f> arriving;
    // The same as ArrivingLight::leaving, W.
    std::vector<Vec3f> leaving;
    int iterations = 0;
    double residual = 0;
};

// Solves x = G (s x + source) / measure + (what comes from beyond the sides) for the mean radiance
// x that arrives at each element: s is the scattering of zones in 1/m or the albedo of patches,
// `source` is in W/(m^3 sr) or W/(m^2 sr). Scattering is even. Throws Error{Usage} when the limits
// do not suffice, Error{Resource} for a matrix that is too large, Error{Cancelled}.
ZoneSolution solve_zones(const ZoneSweep& sweep, std::span<const Vec3f> source, ZoneSolver solver,
                         const ZoneSolveLimits& limits, Job& job);

// What scatters: s above, by element.
std::vector<Vec3f> scattering_of_elements(const Enclosure& enclosure);

}  // namespace gischt
