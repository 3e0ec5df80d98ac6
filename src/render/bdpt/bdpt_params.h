// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/path/path_params.h"

namespace gischt {

// What the weights of the strategies know of distances.
enum class StrategyWeights {
    Directions,  // densities of directions alone (Pharr, Jakob, Humphreys 2016)
    Distances,   // also about how much light the media let through between two vertices
};

// The parameters of bidirectional path tracing.
struct BdptParams {
    StrategyWeights weights = StrategyWeights::Directions;
    TransmittanceEstimator shadow = TransmittanceEstimator::ResidualRatio;  // not Cached
    double roulette = 0.1;     // subpaths weaker than this share of their start may end at random
    double connection = 0.05;  // the same of connections, as a share of the brightest
};

const Table<BdptParams>& bdpt_table();

}  // namespace gischt
