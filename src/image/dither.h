// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gischt {

// Side of the dither tile in pixels.
inline constexpr int dither_size = 64;

// Threshold in ]0,1[ of a pixel, for one of the channels 0 to 3: blue noise, so that the rounding
// error sits in the high frequencies that the eye does not see (void and cluster, Ulichney 1993),
// computed once in about 20 ms, from integers alone: the same on every machine. All thresholds
// (k + 1/2) / 4096 occur once in a tile; channels read shifted copies of it.
float dither_threshold(int x, int y, int channel);

// Rounds `code`, in units of the last bit, up or down such that its mean over the tile is `code`.
// Whole numbers stay as they are: black is black. Result in [0, largest]; NaN gives 0.
inline int dither(float code, int largest, float threshold) {
    if (!(code > 0)) return 0;
    if (code >= static_cast<float>(largest)) return largest;
    const int base = static_cast<int>(code);
    return base + (code - static_cast<float>(base) > threshold ? 1 : 0);
}

}  // namespace gischt
