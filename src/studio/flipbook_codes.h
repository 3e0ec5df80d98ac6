// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string_view>

#include "image/display.h"
#include "image/image.h"

namespace gischt {

// 8-bit codes of the sheets of a flipbook, without dither: cells are cut out, scaled and blended.

// Of values in [0,1] that are data, in the order of the three or four channels named; what is
// outside is cut.
DisplayImage data_codes(const Image& image, std::initializer_list<std::string_view> channels);

// Of R, G, B / scale, by the sRGB curve alone.
DisplayImage light_codes(const Image& image, float scale);

// Of R, G, B, A by exposure in stops, tone curve and sRGB curve; A as it is. The tone curve acts on
// the light of what is there, not on how much of it there is: on premultiplied values after
// division by the coverage, or by their own largest where that is more.
DisplayImage color_codes(const Image& image, ToneKind tone, double exposure, bool premultiplied);

}  // namespace gischt
