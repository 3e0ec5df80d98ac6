// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/film.h"
#include "image/image.h"

namespace gischt {

// Makes a whole picture of one whose first samples are not complete (coarse_order.h): a pixel takes
// the mean of the samples around it, with Gaussian weights (standard deviation: 1.4 blocks) and
// linear between blocks. The blocks are of the finest size of which all those around have samples.
// Depth (Z) is not averaged: a pixel without sample takes that of its block's first one. Pixels
// of 2x2 blocks that are complete keep their bits, and so does a film with a sample in every pixel.
// `image` is of film.image().
void fill_coarse(const Film& film, Image& image);

}  // namespace gischt
