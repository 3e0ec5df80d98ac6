// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "image/film.h"
#include "math/pixel_sampler.h"
#include "render/aov.h"
#include "render/method.h"

namespace gischt {

// The progressive loop that every sampling method shares: it decides which sample of which pixel
// comes next, a worker of the method follows its light, the film adds it up.

// Dimensions of PixelSample::numbers that the loop itself takes; a method's own start at `Free`.
struct SampleDimension {
    enum : std::uint32_t { Film, Lens, Time, Free };
};

// One sample to take.
struct PixelSample {
    int x = 0, y = 0;               // the pixel
    std::uint32_t index = 0;        // of the sample in the pixel
    double film_x = 0, film_y = 0;  // point of the picture in pixels, placed by the filter
    Vec2f lens{0.5f, 0.5f};         // in [0,1)^2: camera.ray(film_x, film_y, lens, time)
    double time = 0.5;              // in [0,1): share of the shutter's time that has passed
    PixelSampler numbers;           // of this sample
};

// Follows the light of one sample after the other. Each belongs to one thread at a time, but sees
// pixels in no particular order: what it leaves behind may be scratch memory only.
class PixelWorker {
  public:
    virtual ~PixelWorker() = default;
    // Fills `out` (black with alpha 1 when it comes; the weight is the loop's) and `extra`, one
    // value per channel of the task's layout, all 0 when it comes.
    virtual void sample(const PixelSample& at, FilmSample& out, std::span<float> extra) = 0;

    // Light of the sample's light path that lands elsewhere; empty when it comes.
    std::vector<FilmSplat> splats;

    std::int64_t rays = 0, lookups = 0;  // for the statistics
};

// What a method gives to the loop. The worker may refer to the view.
struct ProgressiveTask {
    std::string_view method;  // for the progress, times and metadata
    AovLayout layout;         // of aov_layout: the film's channels beside R, G, B, A, Z
    // Called by several threads, one at a time.
    std::function<std::unique_ptr<PixelWorker>()> make_worker;
    // For workers that share something which serves `group` samples of each pixel and is made anew
    // then: called by one thread, while no worker is at work, before samples of the numbers
    // [n group, (n + 1) group) are taken, which all pixels are before those of n + 1. No part of
    // the picture is left out early then. Null: nothing of the kind.
    std::function<void(int n)> prepare;
    int group = 1;

    // The film gets a layer of splats, and each sample of a pixel has a light path.
    bool has_light_paths = false;
    // In place of these: light of `painted_paths` paths all over the picture, countable, in any
    // number of parts. Called once for each index of samples, in their order, one at a time.
    std::function<std::vector<std::vector<FilmSplat>>(std::uint32_t index)> paint;
    std::int64_t painted_paths = 1;
};

// Renders the samples [first_sample, first_sample + samples_per_pixel) of every pixel of the view,
// in passes over the whole picture that double. Stops earlier when the noise or the time is
// reached. The time is looked at after every pixel. The first pass of one sample goes from coarse
// to fine (image/coarse_order.h): one pixel of every block of 8x8 is always taken, and pixels that
// have none yet show their block's, so that the picture has no holes. Partial pictures and
// checkpoints come between pixels too, when a pass takes long.
//
// With settings.noise and settings.adaptive, from 16 samples on, a pass leaves out each tile of
// 16x16 pixels that is good enough together with its eight neighbours: mean variance of the pixels'
// means at most noise^2 * (mean luminance of the tile) * (that of the picture). When all tiles obey
// that, the picture's own relative noise is at most `noise`, since the mean of the bounds is (noise
// * mean)^2; dark parts may have less absolute, and more relative noise than bright ones, as the
// eye sees it. Stopping by estimates from the samples themselves favours lucky ones; with at least
// 16 * 256 samples per estimate, over nine tiles, that bias lies far below the noise asked for.
//
// Bits: the same for any number of threads, and when the work was cut short and taken up again;
// those of a time limit depend on the time.
// Throws Error{Cancelled}; Error{Usage} when settings.film cannot be gone on with; and what the
// worker throws.
RenderResult render_progressively(const View& view, const RenderSettings& settings,
                                  const ProgressiveTask& task, Job& job);

}  // namespace gischt
