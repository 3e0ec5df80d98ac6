// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "schema/table.h"

namespace gischt {

// How the light of photons in media is gathered.
enum class PhotonGather {
    Points,  // at places of a ray, from the photons in a ball around (Jensen & Christensen 1998)
    Beams,   // all along the ray at once, each photon being a ball (Jarosz, Zwicker, Jensen 2008)
};

// The parameters of photon mapping.
struct PhotonParams {
    std::int64_t photons = 1'000'000;  // kept in one map, about
    int passes = 0;                    // maps at most; 0: as many as there are samples for
    int pass_samples = 4;              // of a pixel, that one map serves
    PhotonGather gather = PhotonGather::Beams;
    int nearest = 30;        // photons from whose distance a radius follows
    double radius = 0;       // m, of all photons in the first map; 0: from the nearest
    double reduction = 0.7;  // share of further photons that each further map gathers
    double shrink = 0;    // by which the photons gathered at a point grow fewer per optical depth
    int steps = 16;       // places of a ray at which photons are gathered (points)
    double aim = 0.5;     // share of the photons sent towards media, glass and metal
    int points = 8;       // of a camera ray, at which direct light is taken
    int equiangular = 4;  // as render.path.equiangular
};

const Table<PhotonParams>& photon_table();

}  // namespace gischt
