// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/image.h"

namespace gischt {

// The image at another size: every new pixel is the mean over the area that it covers, in all
// channels (infinite depths make the mean infinite). Enlarging gives square blocks. The metadata is
// kept. Throws as Image does.
Image resize(const Image& image, int width, int height);

// The largest size within width x height that keeps the shape, then resize().
Image fit(const Image& image, int width, int height);

// Copies the color (and what other channels both have) of `part` with its top left corner at
// (x, y); what lies outside is left out.
void paste(Image& image, const Image& part, int x, int y);

}  // namespace gischt
