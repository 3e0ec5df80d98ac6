// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "math/vec.h"

namespace gischt {

// A piecewise constant density over the unit square, on a grid of cells, to draw points from
// (Pharr, Jakob, Humphreys 2023, Physically Based Rendering, A.5).
class Distribution2d {
  public:
    // Columns * rows weights >= 0, x fastest, in proportion to which the cells are drawn. All zero:
    // evenly.
    Distribution2d(std::vector<double> weights, int columns, int rows);

    // A point for u in [0,1)^2; keeps the stratification of u.
    Vec2d sample(Vec2f u) const;
    // The density there; its integral is 1.
    double density(const Vec2d& point) const;

  private:
    int columns_, rows_;
    // Cumulative sums from 0 to 1, over the rows and over the columns of each row. In double:
    // beside a sun in the same row the sky's cells are below the resolution of float.
    std::vector<double> row_cdf_, column_cdf_, density_;
};

}  // namespace gischt
