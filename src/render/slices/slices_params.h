// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/realtime/grid_params.h"

namespace gischt {

enum class SliceKind { Axis, HalfAngle };
enum class SliceSampling { Texture, Vertex };

// The parameters of the slices.
struct SlicesParams {
    GridParams grid;
    SliceKind kind = SliceKind::Axis;
    SliceSampling sampling = SliceSampling::Texture;
    double spacing = 1;      // cells between two slices
    int light_pixels = 256;  // along an edge of the light buffer
    double fade = 0.1;       // difference of two direction cosines below which two stacks are mixed
};

const Table<SlicesParams>& slices_table();

}  // namespace gischt
