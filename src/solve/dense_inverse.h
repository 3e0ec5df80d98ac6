// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solve/stencil.h"

namespace gischt {

// The inverse of the operator of a small level, for the bottom of the V-cycle. Parts of the level
// that nothing holds (connected cells without a Fixed side, with zero shift) are singular; there it
// is the inverse on vectors of zero mean. Costs cells^3 / 3 to make, cells^2 to apply.
class DenseInverse {
  public:
    static constexpr int max_cells = 216;

    DenseInverse() = default;
    explicit DenseInverse(const StencilLevel& level);

    // z = A^-1 r on the level's cells.
    void apply(const SplitField& r, SplitField& z);

  private:
    std::vector<int> value_;      // field index of each cell that takes part
    std::vector<float> inverse_;  // row by row
    std::vector<float> r_;
};

}  // namespace gischt
