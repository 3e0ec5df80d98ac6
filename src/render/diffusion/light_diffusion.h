// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "render/zonal/zone_grid.h"

namespace gischt {

// What diffuses: media on a grid of cubic cells, and the sources of light that was scattered once.
struct DiffusionProblem {
    ZoneGrid grid;                            // coefficients as they are
    std::vector<Vec3f> transport_extinction;  // absorption + scattering (1 - g), 1/m
    // Scattered light: its power, integrated over all directions, W/m^3, and its first moment, by
    // component, W/m^3: g times what comes straight from the lights.
    std::vector<Vec3f> power;
    std::array<std::vector<Vec3f>, 3> moment;
};

// Light that was scattered at least once.
struct DiffuseLight {
    std::vector<Vec3f> fluence;              // integral of radiance over all directions, W/m^2
    std::array<std::vector<Vec3f>, 3> flux;  // its first moment, by component, W/m^2
    int iterations = 0;                      // most of the channels
};

// div F + a phi = power, F = -D grad phi + 3 D moment (Stam 1995, "Multiple scattering as a
// diffusion process"), with D = (2 a + s') / (3 (a + s')^2), s' = s (1 - g), whose decay in the
// depth of a medium is nearly that of transport where plain 1 / (3 (a + s')) is too fast (Grosjean
// 1956; d'Eon & Irving 2011, "A quantized-diffusion model"). Where the medium ends no light comes
// in: phi would vanish 0.7104 free paths beyond, as in Milne's problem (Hopf 1934; Marshak 1947 has
// 2/3). It ends at the sides of the box and at cells thinner than 1e-3 of a free path, in which the
// light is not looked for: they get the mean of those around, so that it may be interpolated.
// Conjugate gradients with the multigrid preconditioner of the pressure; throws Error{Usage} when
// that does not converge, Error{Cancelled}.
DiffuseLight diffuse_light(const DiffusionProblem& problem, double tolerance, Job& job);

}  // namespace gischt
