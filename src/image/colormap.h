// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace gischt {

// Perceptually even colour maps from a number in [0,1].
//   Viridis, Magma, Inferno  van der Walt & Smith 2015 (public domain, CC0)
//   Coolwarm                 blue to red over a light grey at 1/2, for signed values (Moreland
//   2009) Grey                     even steps of sRGB
enum class ColormapKind { Viridis, Magma, Inferno, Coolwarm, Grey };

const std::vector<std::string>& colormap_names();
// By lower-case name. Throws Error{Usage}, listing the names.
ColormapKind colormap_kind(std::string_view name);

// Display-linear Rec.709 in [0,1], to be shown with the tone curve `linear`. t outside [0,1] is
// clamped; NaN is magenta, so that it is seen. Within 2.1 / 255 of the published 256 colours.
Vec3f colormap(ColormapKind kind, float t);

// A bar of the map, t growing to the right, or upwards where the bar is higher than wide.
void draw_colormap(Image& image, Vec2i at, Vec2i size, ColormapKind kind);

}  // namespace gischt
