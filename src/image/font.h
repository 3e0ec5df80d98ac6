// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace gischt {

// A bitmap font of our own: glyphs of 5 x 7 dots for ASCII 32 to 126. A row is 5 bits, the leftmost
// dot being 0x10; rows from the top.
inline constexpr int glyph_width = 5, glyph_height = 7;

// Any other character gets a hollow box.
const std::array<std::uint8_t, 7>& glyph(char character);

}  // namespace gischt
