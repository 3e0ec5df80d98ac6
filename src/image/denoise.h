// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "image/image.h"

namespace gischt {

// Takes the noise of a Monte-Carlo picture out of R, G, B; what they were is kept as noisy.R,
// noisy.G, noisy.B, other layers stay, and the metadata say "denoised". Wants variance.Y, the
// variance of each pixel's luminance (image/film.h). Throws Error{Input} when that or a color is
// missing, when a value is not finite or a variance negative, and for what is denoised already.
//
// Non-local means with variance-aware distances of patches (Rousselle, Knaus, Zwicker 2012). The
// picture x is split into x + n and x - n, n being normal noise of its own variance: for normal
// noise these are independent and of twice the variance (Oliveira, Lei, Tibshirani 2022, "Unbiased
// risk estimation in the normal means problem via coupled bootstrap"). Each half is averaged with
// weights from the other, at three strengths, and the other half tells the error of each strength;
// per pixel the one of least error counts, which may be the picture as it is. What the mean of the
// picture changed by is given back in proportion to the noise. A pixel without noise around it
// keeps its bits. The result is the same on any number of threads. Some 10 s per megapixel and
// core.
void denoise(Image& image, Job& job);

}  // namespace gischt
