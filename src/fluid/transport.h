// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "fluid/advect.h"

namespace gischt {

// Transports a scalar at cell centres over dt seconds such that its integral changes only by what
// passes through the sides: finite volumes with fluxes on the faces, reconstructed upwind to third
// order and limited (van Leer 1979; Koren 1993), in steps of Heun's rule (Shu, Osher 1988) short
// enough that no value leaves the range of its neighbours in a flow without divergence. The work is
// proportional to the active blocks and to the cells that the fluid passes in dt.
//
// `velocity` in m/s on the faces, free of divergence, with its `speeds`; `fraction`: open fractions
// of the faces, null where all are 1. `q.now` is replaced; `q.predicted` and `q.next` are scratch.
// Applies `q.factor`; below `q.floor` a result becomes zero, which is the only loss.
// Throws Error{Cancelled}.
void transport(const Domain& domain, const BlockMap& blocks, const FaceField& velocity,
               const BlockSpeeds& speeds, const FaceField* fraction, double dt, AdvectedScalar& q,
               Job& job);

}  // namespace gischt
