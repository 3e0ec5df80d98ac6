// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_params.h"

namespace gischt {

const Table<PathParams>& path_table() {
    static const Table<PathParams> table =
        Table<PathParams>("path", "Path tracing: every way of the light, without bias")
            .choice("shadow", &PathParams::shadow,
                    {{"ratio", TransmittanceEstimator::Ratio},
                     {"residual_ratio", TransmittanceEstimator::ResidualRatio},
                     {"march", TransmittanceEstimator::March},
                     {"exact", TransmittanceEstimator::Exact},
                     {"cached", TransmittanceEstimator::Cached}},
                    {.help = "How the transmittance towards lights is estimated; the choice "
                             "changes the noise, not the picture"})
            .choice("camera", &PathParams::camera,
                    {{"tracking", CameraSegment::Tracking}, {"profile", CameraSegment::Profile}},
                    {.help = "How the first scattering is found: by null collisions, or from the "
                             "exact optical depth along the camera ray"})
            .add("points", &PathParams::points,
                 {.help = "Points of a camera ray at which direct light is taken (profile)",
                  .min = 1,
                  .max = 256})
            .add("splits", &PathParams::splits,
                 {.help = "How many of these points a path goes on from", .min = 1, .max = 256})
            .add("surface_splits", &PathParams::surface_splits,
                 {.help = "How many paths go on from an evenly scattering surface that the camera "
                          "sees; more pay where fog in front of it is dear (profile); 0: 4 where "
                          "a medium glows, else 1",
                  .min = 0,
                  .max = 256})
            .add("equiangular", &PathParams::equiangular,
                 {.help = "Further points of a camera ray, by the angle under which points, spots "
                          "and lamps see it, at which only their light is taken (profile)",
                  .min = 0,
                  .max = 256})
            .add("bridge", &PathParams::bridge,
                 {.help = "Reach suns through chains of scatterings that end in their direction, "
                          "against sparkles of forward scattering"})
            .add("correction", &PathParams::correction,
                 {.help = "Chance with which a transmittance from the grid is replaced by the "
                          "exact one, which removes the grid's error in the mean",
                  .min = 0.001,
                  .max = 1})
            .add("sky_chance", &PathParams::sky_chance,
                 {.help = "Largest chance with which a sky or environment picture is sampled at a "
                          "scattering in a medium; it is less the more even the sky is, as walks "
                          "find that by themselves",
                  .min = 0,
                  .max = 1})
            .add("roulette", &PathParams::roulette,
                 {.help = "Paths whose weight is below this may end at random", .min = 0, .max = 1})
            .add("cache_nodes", &PathParams::cache_nodes,
                 {.help = "Most nodes of a grid towards a sun; a larger volume gets a coarser one",
                  .min = 1000});
    return table;
}

}  // namespace gischt
