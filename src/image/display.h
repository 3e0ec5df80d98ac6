// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "image/tone_curve.h"

namespace gischt {

// How an image is shown.
struct DisplayOptions {
    ToneKind tone = ToneKind::Filmic;
    double exposure = 0;  // stops
    bool dither = true;   // at 8 bits; 16 bits need none
    // Keep the coverage, as straight alpha, where the image has a channel A. Light that exceeds its
    // coverage (a flame before nothing) gets the coverage that carries it. Without: over black.
    bool alpha = false;
};

// sRGB codes, interleaved, rows from the top.
struct DisplayImage {
    int width = 0, height = 0;
    int channels = 3;  // 4 with alpha
    int bits = 8;      // or 16
    std::vector<std::uint16_t> codes;
    bool is_srgb = true;  // else the codes are data, and no colour to be shown
};

// Exposure, tone curve, sRGB transfer and rounding to `bits` (8 or 16). Throws Error{Input} when
// the image has no colour.
DisplayImage to_display(const Image& image, const DisplayOptions& options, int bits = 8);

// The same at 8 bits without alpha, three bytes per pixel: for movies and windows.
std::vector<std::uint8_t> to_rgb8(const Image& image, const DisplayOptions& options);

}  // namespace gischt
