// SPDX-License-Identifier: Apache-2.0
#include "render/slices/slices_params.h"

namespace gischt {

const Table<SlicesParams>& slices_table() {
    using P = SlicesParams;
    static const Table<P> table =
        Table<P>("slices", "Three stacks of slices through the media, drawn back to front")
            .flat(&P::grid, grid_params_table())
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
            .add("fade", &P::fade,
                 {.help = "Two stacks are mixed while the cosines of their axes with the view "
                          "direction differ by less than this; 0 switches at once",
                  .min = 0,
                  .max = 0.5});
    return table;
}

}  // namespace gischt
