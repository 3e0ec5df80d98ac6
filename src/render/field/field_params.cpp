// SPDX-License-Identifier: Apache-2.0
#include "render/field/field_params.h"

namespace gischt {

const Table<FieldParams>& field_params_table() {
    using P = FieldParams;
    static const Table<P> table =
        Table<P>("field", "Colour map of a 2-D field or of a slice through a 3-D one")
            .add("quantity", &P::quantity,
                 {.help = "A field of the frame (density, temperature, pressure, ...), or speed, "
                          "velocity_x, velocity_y, velocity_z or vorticity"})
            .choice(
                "axis", &P::axis,
                {{"auto", SliceAxis::Automatic,
                  "the thin axis of a 2-D field, else the one that the camera looks along most"},
                 {"x", SliceAxis::X},
                 {"y", SliceAxis::Y},
                 {"z", SliceAxis::Z}},
                {.help = "What the slice is perpendicular to"})
            .add("position", &P::position,
                 {.unit = "m", .help = "Where the slice cuts the axis; the middle by default"})
            .choice("colormap", &P::colormap,
                    {{"viridis", ColormapKind::Viridis},
                     {"magma", ColormapKind::Magma},
                     {"inferno", ColormapKind::Inferno},
                     {"coolwarm", ColormapKind::Coolwarm, "for values of both signs"},
                     {"grey", ColormapKind::Grey}},
                    {.help = "The colours; by default inferno for temperature and flame, coolwarm "
                             "around 0 for values of both signs, else viridis"})
            .add("range", &P::range,
                 {.help = "Values at the two ends of the colours; by default those of the slice"})
            .choice("interpolation", &P::interpolation,
                    {{"nearest", FieldInterpolation::Nearest, "cells as they are"},
                     {"linear", FieldInterpolation::Linear, "bilinear"},
                     {"cubic", FieldInterpolation::Cubic, "smooth, without overshoot"}},
                    {.help = "Between the centres of the cells"})
            .add("legend", &P::legend, {.help = "A bar of the colours with numbers and unit"})
            .add("arrows", &P::arrows, {.help = "Arrows of the velocity"})
            .add("arrow_spacing", &P::arrow_spacing,
                 {.unit = "pixels", .help = "Distance between arrows", .min = 8, .max = 1000})
            .add("arrow_speed", &P::arrow_speed,
                 {.unit = "m/s",
                  .help = "Speed whose arrow is as long as the spacing; by default the largest",
                  .min = 0,
                  .min_open = true});
    return table;
}

}  // namespace gischt
