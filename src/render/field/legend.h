// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image/colormap.h"
#include "image/image.h"
#include "math/vec.h"

namespace gischt {

// Numbers to write along a scale from low to high.
struct Ticks {
    std::vector<double> at;          // multiples of 1, 2 or 5 times a power of ten
    std::vector<std::string> label;  // as short as the step allows, divided by 10^exponent
    int exponent = 0;                // not 0 where the numbers would be long
};

// At most `most` (2 or more) ticks in [low, high]; low < high.
Ticks make_ticks(double low, double high, int most);

// The look of the text around a colour map.
struct LegendStyle {
    Vec3f paper{0.012f, 0.013f, 0.016f}, ink{0.72f, 0.74f, 0.78f};  // display-linear
    int scale = 1;                                                  // pixels per dot of the font
};

// Pixels that draw_legend wants for these ticks.
int legend_width(const Ticks& ticks, const LegendStyle& style);

// A bar of the colours in the column of pixels from (at.x, at.y) down to at.y + height, with ticks
// and numbers to its right.
void draw_legend(Image& image, Vec2i at, int height, ColormapKind map, Vec2d range,
                 const Ticks& ticks, const LegendStyle& style);

}  // namespace gischt
