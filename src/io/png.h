// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "image/display.h"
#include "image/image.h"

namespace gischt {

// Writes codes as PNG, marked sRGB unless they are data, with the metadata as text chunks (tEXt, or
// iTXt where the text is not ASCII). `level` is zlib's: 1 fast, 9 small. Throws Error{Usage} when a
// metadata key is empty or longer than 79 characters (PNG specification, 11.3.4.2), and what
// AtomicFile throws.
void write_png(const std::string& path, const DisplayImage& image, const Metadata& metadata = {},
               int level = 6);

// Any PNG as linear Rec.709 R, G, B and, where it has transparency, premultiplied A. Samples are
// decoded by the sRGB curve unless a gAMA chunk alone names another exponent; the range is [0,1].
// Text chunks become metadata. Throws Error{Input} for what is not a PNG, truncated or broken.
Image read_png(const std::string& path);

}  // namespace gischt
