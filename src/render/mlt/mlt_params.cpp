// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/mlt_params.h"

namespace gischt {

const Table<MltParams>& mlt_table() {
    static const Table<MltParams> table =
        Table<MltParams>("mlt",
                         "Metropolis light transport: paths that bring much light are varied")
            .add(
                "chains", &MltParams::chains,
                {.help = "Markov chains of each round of one mutation per pixel; each starts anew, "
                         "at a path drawn by its light",
                 .min = 1,
                 .max = 65536})
            .add("large_step", &MltParams::large_step,
                 {.help = "Share of the mutations that take a path anew", .min = 0.001, .max = 1})
            .add("film_step", &MltParams::film_step,
                 {.help = "Share of the mutations that take only the place on the film anew, for "
                          "light that comes by the same way everywhere",
                  .min = 0,
                  .max = 1})
            .add("sigma", &MltParams::sigma,
                 {.help = "Standard deviation by which the others move each random number",
                  .min = 0,
                  .max = 1,
                  .min_open = true})
            .add("bootstrap", &MltParams::bootstrap,
                 {.help = "Paths per pixel among which a round draws the starts of its chains, and "
                          "which tell how bright the picture is",
                  .min = 0,
                  .max = 64,
                  .min_open = true})
            .add("direct", &MltParams::direct,
                 {.help = "Light that is scattered once, straight from a light, comes from plain "
                          "samples"})
            .choice("shadow", &MltParams::shadow,
                    {{"ratio", TransmittanceEstimator::Ratio},
                     {"residual_ratio", TransmittanceEstimator::ResidualRatio},
                     {"march", TransmittanceEstimator::March},
                     {"exact", TransmittanceEstimator::Exact}},
                    {.help = "How the transmittance between two points is estimated"})
            .check([](const MltParams& p, const Fail& fail) {
                if (p.large_step + p.film_step > 1) {
                    fail("film_step", "and 'large_step' must not exceed 1 together");
                }
            });
    return table;
}

}  // namespace gischt
