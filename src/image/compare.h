// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "image/image.h"

namespace gischt {

// How far image A is from image B, the reference, over all pixels and the channels R, G, B.
struct Comparison {
    double mse = 0;      // mean of (A - B)^2
    double rmse = 0;     // its root
    double rel_mse = 0;  // mean of (A - B)^2 / (B^2 + 0.01 mean(B)^2)
    double mean_a = 0, mean_b = 0;
    double ratio = 1;           // mean_a / mean_b; 1 where both are 0
    double psnr = 0;            // dB: 10 log10(max(B)^2 / mse), infinity for equal images
    double max_difference = 0;  // of |A - B|, and where
    int max_x = 0, max_y = 0;
    char max_channel = 'R';
    // Values in A or B that are NaN or infinite and not equal in both. If there are any, the errors
    // above are infinity.
    std::size_t not_finite = 0;
};

// Throws Error{Input} when the sizes differ or one has no color.
Comparison compare(const Image& a, const Image& b);

}  // namespace gischt
