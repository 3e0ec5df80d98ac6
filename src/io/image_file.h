// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image/display.h"
#include "image/image.h"
#include "io/exr.h"

namespace gischt {

struct WriteOptions {
    DisplayOptions display;  // PNG only; EXR and HDR hold radiance
    int bits = 8;            // PNG: 8 or 16
    ExrOptions exr;
};

// ".exr", ".png", ".hdr".
const std::vector<std::string>& image_extensions();
// By extension, in either case.
bool is_image_file(const std::string& path);

// Reads and writes by extension. Throw Error{Usage} for another extension, listing the valid ones,
// and what the format throws. A PNG notes its tone curve and exposure in its text chunks; the depth
// and further channels go into EXR only.
Image read_image(const std::string& path);
void write_image(const std::string& path, const Image& image, const WriteOptions& options = {});

}  // namespace gischt
