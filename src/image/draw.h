// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "image/image.h"
#include "math/vec.h"

namespace gischt {

// Drawing onto the channels R, G, B of an image (A, where there is one, becomes the coverage too).
// Colors are display-linear, to be shown with the tone curve `linear`. Positions are in pixels from
// the top left corner of the image, the centre of pixel (x, y) being at (x + 1/2, y + 1/2); what
// lies outside is left out.

// Size of a text in pixels at a scale: 6 x 8 per character less the last gap; '\n' breaks lines.
Vec2i text_size(std::string_view text, int scale = 1);

// Text in the built-in 5 x 7 font, its top left corner at (x, y), every dot scale x scale pixels.
void draw_text(Image& image, Vec2i at, std::string_view text, const Vec3f& color, int scale = 1);

// The pixels [x, x + size.x) x [y, y + size.y).
void fill_rectangle(Image& image, Vec2i at, Vec2i size, const Vec3f& color);

// A line with round ends, `width` in pixels, with smooth edges.
void draw_line(Image& image, Vec2f from, Vec2f to, const Vec3f& color, float width = 1);

// A line with a head at `to`; the head is at most 4 widths + 3 pixels long and shrinks with the
// arrow. Nothing is drawn when the ends coincide.
void draw_arrow(Image& image, Vec2f from, Vec2f to, const Vec3f& color, float width = 1);

}  // namespace gischt
