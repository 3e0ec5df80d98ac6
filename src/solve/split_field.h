// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "grid/field.h"

namespace gischt {

// The solver's own order of the 512 values of a tile: first the 256 red cells (i + j + k even),
// then the 256 black ones. A colour is stored plane by plane; in a plane the rows 2J and 2J + 1
// share one packed row, in which lane i is the one of the cells (i, 2J, k), (i, 2J + 1, k) that has
// the colour. All neighbours of a cell have the other colour, and they lie in the same lane of the
// same packed row (one y neighbour), of the row before or after (the other one, by parity), of the
// planes before and after, and in the lanes beside. So a Gauss-Seidel sweep over one colour uses
// every SIMD lane, reads half of the bytes and shuffles nothing.
inline constexpr int color_values = tile_values / 2;

// Colours by number: 0 red, 1 black.
constexpr int split_index(const TileShape& s, int i, int j, int k) {
    const int color = (i + j + k) & 1;
    const int packed_row = (k << (s.log_y - 1)) + (j >> 1);
    return color * color_values + (packed_row << s.log_x) + i;
}
constexpr int split_index(const TileShape& s, const Vec3i& local) {
    return split_index(s, local.x, local.y, local.z);
}

// One value per cell of a level, in split order; 64 bytes of padding on both ends let kernels load
// one lane too early or too late. Tiles past the map's are ghosts; the last one stays zero.
class SplitField {
  public:
    SplitField() = default;
    explicit SplitField(int tiles)
        : values_(static_cast<std::size_t>(tiles) * tile_values + 2 * padding, 0.0f) {}

    float* data() { return values_.data() + padding; }
    const float* data() const { return values_.data() + padding; }
    float* tile(int t) { return data() + static_cast<std::size_t>(t) * tile_values; }
    const float* tile(int t) const { return data() + static_cast<std::size_t>(t) * tile_values; }

  private:
    static constexpr std::size_t padding = 16;
    AlignedVector<float> values_;
};

}  // namespace gischt
