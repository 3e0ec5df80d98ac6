// SPDX-License-Identifier: Apache-2.0
#include "render/slices/slices_params.h"

namespace gischt {

const Table<SlicesParams>& slices_table() {
    using P = SlicesParams;
    static const Table<P> table =
        Table<P>("slices", "Slices through the media, drawn one after the other")
            .flat(&P::grid, grid_params_table())
            .choice("kind", &P::kind,
                    {{"axis", SliceKind::Axis,
                      "across x, y and z: the stack nearest to the view, light by the grid"},
                     {"half_angle", SliceKind::HalfAngle,
                      "across the half vector between view and strongest light, whose shadow "
                      "grows slice by slice in a buffer seen from the light"}},
                    {.help = "How the slices lie"})
            .choice("sampling", &P::sampling,
                    {{"texture", SliceSampling::Texture, "trilinear at every pixel"},
                     {"vertex", SliceSampling::Vertex,
                      "the classical way: colours at the corners of a mesh over each slice"}},
                    {.help = "Where the density is taken"})
            .add(
                "spacing", &P::spacing,
                {.unit = "cells",
                 .help = "Distance of two slices; the opacity is corrected for it. Vertex sampling "
                         "takes every cell's layer",
                 .min = 0.1,
                 .max = 16})
            .add("light_pixels", &P::light_pixels,
                 {.unit = "pixels",
                  .help = "Along an edge of the light buffer of half-angle slices",
                  .min = 16,
                  .max = 8192})
            .add("fade", &P::fade,
                 {.help = "Two axis stacks are mixed while the cosines of their axes with the view "
                          "direction differ by less than this; 0 switches at once",
                  .min = 0,
                  .max = 0.5});
    return table;
}

}  // namespace gischt
