// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/random.h"
#include "math/vec.h"

namespace gischt {

// The order of a picture's first samples, from coarse to fine: one pixel of every block of 8x8,
// then one of every 4x4, of every 2x2, and the rest. Which one varies from block to block of 8x8,
// so that the first picture has no aliasing of a regular grid.
class CoarseOrder {
  public:
    static constexpr int coarsest = 8;  // pixels

    CoarseOrder(int width, int height) : width_(width), height_(height) {}

    // The pixel of the block of that edge (1, 2, 4 or 8) around a pixel that comes first.
    Vec2i first_of(int x, int y, int edge) const {
        const int x0 = x & ~(coarsest - 1), y0 = y & ~(coarsest - 1);
        // What the border cuts begins in its corner, which lies in the picture.
        const bool is_cut = x0 + coarsest > width_ || y0 + coarsest > height_;
        const auto h = static_cast<int>(
            is_cut ? 0
                   : mix64(static_cast<std::uint64_t>(y0) << 32 | static_cast<unsigned>(x0)) >> 58);
        return {(x & ~(edge - 1)) | (h & 7 & (edge - 1)),
                (y & ~(edge - 1)) | (h >> 3 & (edge - 1))};
    }
    bool is_first(int x, int y, int edge) const { return first_of(x, y, edge) == Vec2i{x, y}; }

  private:
    int width_, height_;
};

}  // namespace gischt
