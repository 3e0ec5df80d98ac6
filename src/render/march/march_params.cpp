// SPDX-License-Identifier: Apache-2.0
#include "render/march/march_params.h"

namespace gischt {

const Table<MarchParams>& march_table() {
    static const Table<MarchParams> table =
        Table<MarchParams>("march",
                           "Ray marching with direct light: eq. 19, a second march to each light")
            .add("step", &MarchParams::step,
                 {.unit = "voxels",
                  .help = "Largest step along a camera ray",
                  .min = 0.01,
                  .max = 16})
            .add("step_depth", &MarchParams::step_depth,
                 {.help = "Largest optical depth of a step: dense media get shorter ones",
                  .min = 0.001,
                  .max = 100})
            .add("shadow_step", &MarchParams::shadow_step,
                 {.unit = "voxels", .help = "Step of the march to a light", .min = 0.01, .max = 16})
            .add("cutoff", &MarchParams::cutoff,
                 {.help = "Transmittance at which a camera ray ends", .min = 0, .max = 0.1})
            .add("light_cache", &MarchParams::light_cache,
                 {.help = "Compute the light on grids once per frame; off, every step marches to "
                          "every light and samples the sky: slow, the reference"})
            .add("cache_nodes", &MarchParams::cache_nodes,
                 {.help = "Most nodes of one grid; a larger volume gets a coarser grid",
                  .min = 1000})
            .add("shadow_spacing", &MarchParams::shadow_spacing,
                 {.unit = "voxels",
                  .help = "Distance of the nodes of the grids of shadow towards suns and points; 0 "
                          "takes 1, or 1/2 where a voxel's optical depth exceeds 1/2",
                  .min = 0,
                  .max = 64})
            .add("sky_nodes", &MarchParams::sky_nodes,
                 {.help = "Nodes of the grid of sky light over a medium's box, at least half a "
                          "voxel apart",
                  .min = 1000})
            .add("sky_directions", &MarchParams::sky_directions,
                 {.help = "Directions from which that grid takes the sky", .min = 24, .max = 4096})
            .add("directions", &MarchParams::directions,
                 {.help = "With a depth above 1: directions from which light is gathered at a "
                          "place, M in eq. 20",
                  .min = 1,
                  .max = 4096})
            .add("gathers", &MarchParams::gathers,
                 {.help = "Places at which a ray gathers, per share of the light that it scatters; "
                          "0 gathers at every step",
                  .min = 0,
                  .max = 1000})
            .add(
                "thinning", &MarchParams::thinning,
                {.help = "Factor of directions and gathers from one level of gathering rays to the "
                         "next; one of each is left",
                 .min = 0.01,
                 .max = 1})
            .add("deep_step", &MarchParams::deep_step,
                 {.help = "Steps of gathering rays, as a multiple of those of camera rays",
                  .min = 0.1,
                  .max = 16})
            .add("sky_samples", &MarchParams::sky_samples,
                 {.help = "Directions of the sky per sample, in each of two sets, at a point of a "
                          "surface; without light_cache at every step",
                  .min = 1,
                  .max = 1024});
    return table;
}

}  // namespace gischt
