// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/billboards/billboards_params.h"

namespace gischt {

// The pictures of billboards, all of one size: colour that multiplies the particle's, not
// multiplied by alpha, and alpha.
struct SpriteSheet {
    int width = 0, height = 0, count = 0;
    bool is_sequence = false;   // shown one after the other, and mixed between two
    bool is_round = false;      // nothing outside of the disc that touches the edges
    bool is_white = false;      // only alpha is kept: a fourth of the work
    std::vector<float> texels;  // RGBA or alpha, rows from bottom to top, picture after picture
};

// Made of noise, or cut out of params.picture. Throws Error{Input} where its edges are not
// multiples of the sheet's columns and rows, and Error{Usage} where there is a file but no picture.
SpriteSheet make_sprites(const BillboardsParams& params);

}  // namespace gischt
