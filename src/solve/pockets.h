// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solve/stencil.h"

namespace gischt {

// The connected parts of a level that nothing holds: no Fixed side, no shift, no extra. The
// operator is singular on each of them, one constant per part. Tiles without cuts are connected as
// a whole, so the search costs time for the cut tiles only.
class Pockets {
  public:
    Pockets() = default;
    explicit Pockets(const StencilLevel& finest);

    bool is_empty() const { return cells_.empty(); }
    int count() const { return static_cast<int>(cells_.size()); }

    // Subtracts from each pocket its mean. In split order (a SplitField's data) or the user's
    // order.
    void remove_mean_split(const StencilLevel& level, float* values) const;
    void remove_mean_natural(const StencilLevel& level, float* values) const;

  private:
    // index[v]: where the cell v (user's order) of a tile lies.
    void remove_mean(const StencilLevel& level, const int* index, float* values) const;

    static constexpr int none = -1, by_cell = -2;
    std::vector<int> tile_pocket_;  // pocket, none or by_cell
    std::vector<int> first_label_;  // by_cell: where the tile's 512 labels begin
    std::vector<int> labels_;       // pocket or none, user's order
    std::vector<double> cells_;     // number of cells by pocket
};

}  // namespace gischt
