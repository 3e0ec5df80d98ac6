// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/bdpt_params.h"

namespace gischt {

const Table<BdptParams>& bdpt_table() {
    static const Table<BdptParams> table =
        Table<BdptParams>("bdpt",
                          "Bidirectional path tracing: paths from the camera and the lights")
            .choice("weights", &BdptParams::weights,
                    {{"directions", StrategyWeights::Directions},
                     {"distances", StrategyWeights::Distances}},
                    {.help = "What the weights of the ways to find a path know: how likely its "
                             "directions are, or also how much light the media between let "
                             "through; the choice changes the noise, not the picture"})
            .choice("shadow", &BdptParams::shadow,
                    {{"ratio", TransmittanceEstimator::Ratio},
                     {"residual_ratio", TransmittanceEstimator::ResidualRatio},
                     {"march", TransmittanceEstimator::March},
                     {"exact", TransmittanceEstimator::Exact}},
                    {.help = "How the transmittance between two points is estimated"})
            .add("roulette", &BdptParams::roulette,
                 {.help = "Paths whose weight is below this may end at random", .min = 0, .max = 1})
            .add("connection", &BdptParams::connection,
                 {.help = "Connections of a light path with a camera path that are weaker than "
                          "this share of the brightest so far may be left out at random",
                  .min = 0,
                  .max = 1});
    return table;
}

}  // namespace gischt
