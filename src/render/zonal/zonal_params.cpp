// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/zonal_params.h"

namespace gischt {

const Table<ZonalParams>& zonal_table() {
    static const Table<ZonalParams> table =
        Table<ZonalParams>("zonal", "Finite elements: light in equilibrium between zones")
            .add("zones", &ZonalParams::zones,
                 {.help = "Zones along the longest edge of the box around the media; a quarter of "
                          "the error per doubling",
                  .min = 1,
                  .max = 256})
            .choice(
                "solver", &ZonalParams::solver,
                {{"auto", ZonalSolver::Auto},
                 {"exchange", ZonalSolver::Exchange},
                 {"sweeps", ZonalSolver::Sweeps},
                 {"ordinates", ZonalSolver::Ordinates}},
                {.help = "A matrix of exchange factors, sweeps along lines without a matrix, or "
                         "discrete ordinates, which know the phase function; auto takes the "
                         "matrix where it fits"})
            .add("memory_limit", &ZonalParams::memory_limit,
                 {.unit = "MB",
                  .help = "Most memory of a matrix, or of ordinates; 4 bytes per pair of zones, 12 "
                          "where the extinction has colours",
                  .min = 1})
            .add("lines", &ZonalParams::lines,
                 {.help = "Lines that start at each zone's face on the sides; some six times as "
                          "many pass each zone",
                  .min = 4,
                  .max = 65536})
            .add("light_samples", &ZonalParams::light_samples,
                 {.help = "Points of each zone at which the light that comes straight from the "
                          "lights is averaged",
                  .min = 1,
                  .max = 65536})
            .add("ordinates", &ZonalParams::ordinates,
                 {.help = "Cosines of the ordinates, an even number, with twice as many angles "
                          "around each",
                  .min = 2,
                  .max = 32})
            .add("tolerance", &ZonalParams::tolerance,
                 {.help = "Relative error at which the equilibrium is reached",
                  .min = 1e-6,
                  .max = 0.1})
            .add("iterations", &ZonalParams::iterations,
                 {.help = "Most iterations until then", .min = 1})
            .add("thickness", &ZonalParams::thickness,
                 {.help = "Largest optical thickness of a zone, with reduced scattering; thicker "
                          "ones would let light through too easily, and are refused",
                  .min = 0.01})
            .add("surfaces", &ZonalParams::surfaces,
                 {.help = "Extends the box of zones to all solids of finite size; else only those "
                          "parts of them that lie in the media's box exchange light"})
            .add("step", &ZonalParams::step,
                 {.unit = "voxels",
                  .help = "Largest step of the march that gathers the light",
                  .min = 0.01,
                  .max = 64})
            .add("step_depth", &ZonalParams::step_depth,
                 {.help = "Largest optical depth of such a step", .min = 0.001, .max = 100});
    return table;
}

}  // namespace gischt
