// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/realtime/particle_stage.h"

namespace gischt {

// The parameters of the points.
struct PointsParams {
    ParticleDrawParams draw;  // opaque, unless it is said otherwise
    double size = 0;          // pixels across; 0: as large as the particles are
    double least_size = 1;    // pixels

    PointsParams() { draw.blend.preset = BlendPreset::Opaque; }
};

const Table<PointsParams>& points_table();

}  // namespace gischt
