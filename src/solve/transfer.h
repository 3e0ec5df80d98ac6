// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/stencil.h"

namespace gischt {

// R and P of kernels.h for all cells, from the definition and without SIMD: for levels with
// periodic copies (StencilLevel::copies), where a coarse cell may lack children and neighbours wrap
// around inside a tile, and as the reference for the fast ones. Ghosts are not read.

// coarse r = R res.
void restrict_wrapped(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& res,
                      SplitField& coarse_r);
// z += P e.
void prolong_wrapped(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& e,
                     SplitField& z);

}  // namespace gischt
