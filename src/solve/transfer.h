// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/kernels.h"

namespace gischt {

// restrict_red and prolong_red without SIMD, cell by cell from the definition. For levels with
// periodic copies (StencilLevel::copies), whose last coarse cells wrap around inside a tile, and as
// the reference for the fast ones.
void restrict_slow(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& res,
                   SplitField& coarse_r);
void prolong_slow(const StencilLevel& fine, const StencilLevel& coarse, const SplitField& e,
                  const SplitField& r, SplitField& z);

}  // namespace gischt
