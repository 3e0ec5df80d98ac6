// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/field/field_params.h"
#include "render/method.h"

namespace gischt {

// Colour map of one quantity of the first frame of the view that has it: a 2-D field as it is, of a
// 3-D one a slice. The slice fills the picture at its own aspect, the cells being square as they
// are in space, with x (or y) to the right; the camera only decides an axis that is in doubt.
// Values outside of the cells are the field's background.
//
// The picture is display-referred: R, G, B are display-linear colours of the map, A is 1, and the
// metadata "tone" = "linear" and "display_referred" = "true" tell those who write it as PNG to
// apply no exposure, no tone curve but linear, and no dither, so that the colours are those of the
// map. "quantity", "unit", "range_low", "range_high" and "slice" name what is shown. There is
// no channel Z.
std::unique_ptr<RenderMethod> make_field_method(const FieldParams& params);

inline constexpr std::string_view field_simulates =
    "no light: the numbers themselves, as colours with a legend; arrows of the velocity";
inline constexpr std::string_view field_leaves_out =
    "everything outside of one plane; camera and lights";
inline constexpr std::string_view field_cost = "pixels; 10 ms for a picture";

}  // namespace gischt
