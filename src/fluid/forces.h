// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/advect.h"

namespace gischt {

// What acts on the fluid at one moment, per unit mass.
struct Forces {
    Vec3d gravity;                 // m/s^2
    Vec3d acceleration;            // m/s^2, the same everywhere
    double density_weight = 0;     // kappa: relative weight of density 1 (1)
    double thermal_expansion = 0;  // beta, 1/K
    double confinement = 0;        // epsilon, 1/s
    Vec3d wind;                    // m/s
    double wind_rate = 0;          // 1/s
};

// One explicit step of the forces from `in` to `out`: buoyancy g (kappa density - beta (T - T_a)),
// the mean of both cells of a face; vorticity confinement epsilon h (N x omega), N being the
// direction in which |omega| grows (Fedkiw, Stam, Jensen 2001), a rate like the others; a
// uniform acceleration; and the relaxation towards the wind, exact in dt. `density` may be null;
// `temperature` is T - T_ambient.
void apply_forces(const Domain& domain, const BlockMap& blocks, const Forces& forces, double dt,
                  const SparseField& density, const SparseField& temperature, const FaceField& in,
                  FaceField& out);

// Vorticity at the cell centres of `cells`, from central differences of cell-centred velocities,
// 1/s. `velocity` holds the faces on a lattice with two more cells on every side. The outputs are
// arrays on the same lattice; in 2-D only z is written.
void compute_vorticity(const Lattice& lattice, const Box3i& cells, bool is_2d, double h,
                       const std::array<const float*, 3>& velocity,
                       const std::array<float*, 3>& vorticity);

}  // namespace gischt
