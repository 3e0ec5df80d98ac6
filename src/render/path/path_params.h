// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "schema/table.h"

namespace gischt {

// How the transmittance towards a light is estimated; all are unbiased.
enum class TransmittanceEstimator {
    Ratio,          // ratio tracking against the majorants of 4^3 blocks (Novak et al. 2014)
    ResidualRatio,  // the blocks' means as control, the residual tracked
    March,          // even steps, freed of their bias by a random term of a telescoping sum
    Exact,          // no noise: the optical depth integrated cell by cell
    Cached,         // from a grid towards suns, made exact at random (a debiased control variate)
};

// How the first scattering of a camera ray is found.
enum class CameraSegment {
    Tracking,  // like every other: one distance by null collisions
    Profile,   // the optical depth along the ray is computed exactly, distances are stratified
};

// The parameters of path tracing.
struct PathParams {
    TransmittanceEstimator shadow = TransmittanceEstimator::Cached;
    CameraSegment camera = CameraSegment::Profile;
    int points = 8;          // of a camera ray with a profile, at which direct light is taken
    int splits = 8;          // of them from which paths go on
    int surface_splits = 0;  // paths that go on from an evenly scattering surface that it meets
    int equiangular = 4;     // more points of such a ray, for lights at finite places alone
    bool bridge = true;      // suns are reached through chains of turns that end in their direction
    double correction = 0.1;  // chance that a cached transmittance is made exact
    double sky_chance = 1;    // largest with which a sky is sampled at a scattering in a medium
    double roulette = 0.1;    // paths weaker than this share of their start may end at random
    std::int64_t cache_nodes = 40'000'000;  // of one grid towards a sun
};

const Table<PathParams>& path_table();

}  // namespace gischt
