// SPDX-License-Identifier: Apache-2.0
#include "render/points/points_params.h"

namespace gischt {

const Table<PointsParams>& points_table() {
    using P = PointsParams;
    static const Table<P> table =
        Table<P>("points", "Particles as round points, drawn by OpenGL")
            .add("size", &P::size,
                 {.unit = "pixels",
                  .help = "Diameter of a point; 0 takes the size that the particle has there",
                  .min = 0,
                  .max = 1024})
            .add("least_size", &P::least_size,
                 {.unit = "pixels",
                  .help = "Smallest diameter; smaller particles get that much less opaque where "
                          "they are blended",
                  .min = 1,
                  .max = 64})
            .flat(&P::draw, particle_draw_table());
    return table;
}

}  // namespace gischt
