// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "image/film.h"

namespace gischt {

// Pixels [x0, x1) x [y0, y1).
struct PixelTile {
    int x0, y0, x1, y1;
};

// A picture cut into square tiles, those at the right and lower edge smaller; row by row.
class TileGrid {
  public:
    TileGrid(int width, int height, int edge)
        : width_(width),
          height_(height),
          edge_(edge),
          columns_((width + edge - 1) / edge),
          rows_((height + edge - 1) / edge) {}

    std::size_t count() const { return static_cast<std::size_t>(columns_ * rows_); }
    PixelTile at(int number) const;

    // Which tiles need more samples for a relative noise (see render/progressive.h): those whose
    // own mean variance, or that of one of the eight neighbours, is above its bound.
    std::vector<char> noisy(const Film& film, double noise) const;

  private:
    int width_, height_, edge_, columns_, rows_;
};

}  // namespace gischt
