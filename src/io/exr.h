// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace gischt {

struct ExrOptions {
    // 16-bit floats (11 bits of mantissa, 6e-5 to 65504 at full precision) or 32-bit ones. A
    // channel whose largest value is outside [0.0625, 65504] is written as float all the same: half
    // would lose its dark parts or turn into infinity.
    bool half = true;
    // Always 32 bits: lengths, counts, and what is taken differences of.
    std::vector<std::string> float_channels{"Z", "motion.X", "motion.Y", "variance.Y", "samples.Y"};
};

// OpenEXR with ZIP compression, scanlines from the top, Rec.709 chromaticities; the metadata as
// string attributes. Throws Error{Usage} when a metadata key is one of OpenEXR's own, and what
// AtomicFile throws.
void write_exr(const std::string& path, const Image& image, const ExrOptions& options = {});

// All channels of a flat image, scanline or tiled (the finest level), as floats over the display
// window; what the data window leaves out is 0. Further parts of the same size follow as layers,
// named by their part. Colors of other chromaticities are converted to Rec.709. String attributes
// become metadata, sorted by key.
// Throws Error{Input} for what is not such a file, is truncated or broken.
Image read_exr(const std::string& path);

}  // namespace gischt
