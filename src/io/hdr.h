// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "image/image.h"

namespace gischt {

// Radiance pictures (Ward 1991, "Real pixels", Graphics Gems II): 8 bits of mantissa per channel
// and one exponent for the three, so that the error is up to 1/512 of the pixel's largest channel.

// Reads one, flat or run-length coded, of any orientation that has rows from top to bottom or
// bottom to top, as R, G, B. EXPOSURE lines are divided out. Throws Error{Input} for what is
// not such a file (XYZE included), truncated or broken.
Image read_hdr(const std::string& path);

// Writes R, G, B run-length coded; negative values and NaN become 0. The metadata go into comment
// lines. Throws what AtomicFile throws.
void write_hdr(const std::string& path, const Image& image);

}  // namespace gischt
