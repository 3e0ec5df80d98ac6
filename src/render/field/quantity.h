// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "grid/frame.h"
#include "image/colormap.h"

namespace gischt {

// A number per cell that can be shown: a field of a frame, or made from its velocity.
struct Quantity {
    std::string name;
    std::string_view unit;   // a literal; empty for a pure number
    const Field* field{};    // whose cells it lives in
    bool is_signed = false;  // both signs mean something: the colours are even around 0
    ColormapKind colormap = ColormapKind::Viridis;
    std::function<float(const Vec3i& cell)> at;  // outside of the tiles: from the background
};

// The quantity of this name, `normal` being the axis of the slice (vorticity is the component of
// curl u along it, 1/s, by central differences). nullptr in `field` when the frame lacks it.
Quantity find_quantity(const Frame& frame, std::string_view name, int normal);

// The names that find_quantity knows for a frame.
std::vector<std::string> quantity_names(const Frame& frame);

}  // namespace gischt
