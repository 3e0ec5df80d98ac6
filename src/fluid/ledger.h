// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fluid/advect.h"
#include "fluid/solid_field.h"

namespace gischt {

// Where an amount (the integral of a scalar over the domain without its solids, m^3 or K m^3; in
// 2-D of a layer one cell thick) came from and went since `before`: at any time
//     after = before + sources + inflow - outflow - decayed + diffused + numerical.
struct ScalarLedger {
    double before = 0, after = 0;
    double sources = 0;    // given by sources, less what they took
    double inflow = 0;     // carried in through the sides of the domain
    double outflow = 0;    // carried out
    double decayed = 0;    // by the half-life
    double diffused = 0;   // conducted in through the sides, less what was conducted out
    double numerical = 0;  // the remainder: what advection and rounding make and lose, and what
                           // moving solids cover
};

// Keeps the ledgers of density and heat over the steps of a solver by sums between the phases of a
// step. Only blocks that hold anything are read, once per phase. What passes the sides with the
// flow is estimated before it moves: the volume that the velocity on a side sweeps in dt, with what
// lies in it.
class Ledger {
  public:
    // They must outlive it.
    Ledger(const Domain& domain, const BlockMap& blocks, const SolidField& solids);

    struct Scalars {
        const SparseField *density, *temperature;
    };
    // Before anything of a step.
    void begin_step(const Scalars& now, const FaceField& velocity, double dt);
    // After advection, which has multiplied density and temperature with these factors.
    void note_advection(const Scalars& now, const std::array<double, 2>& decay);
    // After the solids have moved.
    void note_solids(const Scalars& now);
    void note_sources(const Scalars& now);
    // `diffusivity` in m^2/s.
    void note_diffusion(const Scalars& now, const std::array<double, 2>& diffusivity, double dt);

    const ScalarLedger& density() const { return ledgers_[0]; }
    const ScalarLedger& heat() const { return ledgers_[1]; }
    // Starts the accounts anew with what is there.
    void restart(const Scalars& now);

  private:
    void find_covered();
    double amount(const SparseField& field) const;
    double open_part(int axis, const Vec3i& face) const;
    double swept_out(const SparseField& field, const FaceField& velocity, double dt) const;
    double swept_in(const ScalarHold& held, const FaceField& velocity, double dt) const;
    double conducted_in(const SparseField& field, const ScalarHold& held, double diffusivity,
                        double dt) const;
    const ScalarHold& held(std::size_t which) const;
    double change(std::size_t which, const SparseField& field);

    const Domain& domain_;
    const BlockMap& blocks_;
    const SolidField& solids_;
    // Places in the tiles of a block of the cells whose centre is in a solid.
    std::vector<std::vector<std::uint32_t>> covered_;
    std::array<ScalarLedger, 2> ledgers_;
};

}  // namespace gischt
