// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_params.h"

namespace gischt {

const Table<PhotonParams>& photon_table() {
    static const Table<PhotonParams> table =
        Table<PhotonParams>("photon", "Photon mapping: light carried from its sources, then seen")
            .add("photons", &PhotonParams::photons,
                 {.help = "Photons kept in one map, about; they cost some 80 bytes each",
                  .min = 100,
                  .max = 100'000'000})
            .add("passes", &PhotonParams::passes,
                 {.help = "Maps at most, the last one serving all further samples; 1 is the "
                          "classical method, 0 makes a map for each pass_samples samples and "
                          "converges to the truth",
                  .min = 0})
            .add("pass_samples", &PhotonParams::pass_samples,
                 {.help = "Samples of a pixel that one map serves", .min = 1, .max = 1024})
            .choice("gather", &PhotonParams::gather,
                    {{"points", PhotonGather::Points}, {"beams", PhotonGather::Beams}},
                    {.help = "How light in media is gathered: in balls around places of a ray, or "
                             "by the whole ray from photons that are balls themselves"})
            .add("nearest", &PhotonParams::nearest,
                 {.help = "The radius of a photon, or of a gathering, is the distance of so many "
                          "photons in the first map",
                  .min = 4,
                  .max = 10'000})
            .add("radius", &PhotonParams::radius,
                 {.unit = "m",
                  .help = "Radius in the first map in place of the nearest; 0: none",
                  .min = 0})
            .add("reduction", &PhotonParams::reduction,
                 {.help = "The radius shrinks from map to map such that of each further one's "
                          "photons this share is gathered; 1 leaves it as it is",
                  .min = 0.1,
                  .max = 1})
            .add("shrink", &PhotonParams::shrink,
                 {.help = "The number gathered at a point falls with exp(-shrink * optical depth "
                          "from the eye) (points)",
                  .min = 0,
                  .max = 10})
            .add("steps", &PhotonParams::steps,
                 {.help = "Places of a ray at which photons are gathered (points)",
                  .min = 2,
                  .max = 256})
            .add("aim", &PhotonParams::aim,
                 {.help = "Share of the photons of points, suns and skies that are sent towards "
                          "media, glass and metal; the others make up for what these leave out",
                  .min = 0,
                  .max = 0.95})
            .add("points", &PhotonParams::points,
                 {.help = "Points of a camera ray at which direct light is taken",
                  .min = 1,
                  .max = 256})
            .add("equiangular", &PhotonParams::equiangular,
                 {.help = "Further points of a camera ray for points, spots and lamps",
                  .min = 0,
                  .max = 256});
    return table;
}

}  // namespace gischt
