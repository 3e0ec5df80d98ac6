// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "image/colormap.h"
#include "math/vec.h"
#include "schema/table.h"

namespace gischt {

enum class SliceAxis { Automatic, X, Y, Z };
enum class FieldInterpolation { Nearest, Linear, Cubic };

// The parameters of the colour map of a field.
struct FieldParams {
    // density, temperature, pressure ... : a field of the frame; speed, velocity_x, velocity_y,
    // velocity_z, vorticity: made from its velocity.
    std::string quantity = "density";
    SliceAxis axis = SliceAxis::Automatic;  // what the slice is perpendicular to
    std::optional<double> position;         // m along the axis; unset: the middle
    std::optional<ColormapKind> colormap;   // unset: by the quantity
    std::optional<Vec2d> range;             // values at the ends of the map; unset: of the slice
    FieldInterpolation interpolation = FieldInterpolation::Cubic;
    bool legend = true;
    bool arrows = false;
    int arrow_spacing = 32;             // pixels
    std::optional<double> arrow_speed;  // m/s of an arrow as long as the spacing
};

const Table<FieldParams>& field_params_table();

}  // namespace gischt
