// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/path/path_params.h"

namespace gischt {

// The parameters of Metropolis light transport.
struct MltParams {
    int chains = 16;          // of each round of one mutation per pixel
    double large_step = 0.1;  // share of mutations that start anew
    double film_step = 0.2;   // share that take only the place on the film anew
    double sigma = 0.01;      // of small steps, in primary numbers of [0, 1)
    double bootstrap = 0.25;  // paths per pixel that tell a round where its chains start
    bool direct = true;       // paths of two edges are left to plain sampling
    TransmittanceEstimator shadow = TransmittanceEstimator::ResidualRatio;  // not Cached
};

const Table<MltParams>& mlt_table();

}  // namespace gischt
