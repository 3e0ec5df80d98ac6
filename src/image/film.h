// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "image/filter.h"
#include "image/image.h"
#include "math/exact_sum.h"
#include "math/vec.h"

namespace gischt {

// What one sample of a pixel measured.
struct FilmSample {
    Vec3f radiance;   // W/(m^2 sr), Rec.709, premultiplied by alpha
    float alpha = 1;  // coverage
    float depth = std::numeric_limits<float>::infinity();  // metres; infinity where nothing was hit
    float weight = 1;                                      // of FilterSample
};

// Light that lands somewhere on the film. `value` is of one light path, divided by the number of
// pixels: W/(m^2 sr) per pixel area.
struct FilmSplat {
    Vec2f at;  // pixels; may lie outside of the picture
    Vec3f value;
};

// The sums of one pixel, all exact (math/exact_sum.h).
struct FilmPixel {
    ExactSum radiance[3];        // of weight * value
    ExactSum alpha, weight;      // of weight * value, of weight
    ExactSum luminance;          // of value, without weight
    ExactSum depth;              // over the samples that hit something
    ExactSquareSum luminance_2;  // of value^2, without weight
    std::int32_t hits = 0;       // samples that add to the depth
    std::int32_t count = 0;      // samples, with the rejected ones
    std::int32_t rejected = 0;   // samples that count as black
};

// Adds up the samples of every pixel exactly, in fixed point: the same samples give the same bits
// in whatever order they came and however they were split among films that were merged. Use:
//   const FilterSample f = film.sample_filter(u);
//   ... trace through (x + 0.5 + f.offset.x, y + 0.5 + f.offset.y) ...
//   film.add(x, y, {radiance, alpha, depth, f.weight});
// Different pixels may be added to by different threads at once; one pixel by one thread at a time.
// Range: |value| < 5e11 per sample, 2^24 samples per pixel; resolution 5e-20. About 160 bytes per
// pixel and 16 per extra channel.
//
// Light that lands anywhere, not in the pixel that looked for it, is added by splat() to a layer of
// its own: each pixel takes it by the filter around its centre, the footprint. The layer is divided
// by the number of light paths per pixel, whether they reached the film or not. 48 bytes per pixel.
class Film {
  public:
    // `extra` names further channels, such as "direct.R". Throws as Image does.
    Film(int width, int height, ReconstructionFilter filter = ReconstructionFilter(),
         std::vector<std::string> extra = {});

    int width() const { return width_; }
    int height() const { return height_; }
    const ReconstructionFilter& filter() const { return filter_; }
    const std::vector<std::string>& extra_names() const { return extra_names_; }
    FilterSample sample_filter(Vec2f u) const { return filter_.sample(u); }

    // `extra` holds one value per extra channel. A sample that is not a number or out of range
    // (infinite depth aside) counts as black and is reported by rejected().
    void add(int x, int y, const FilmSample& sample, std::span<const float> extra = {});
    // The layer of splats; made by the first call.
    bool has_splats() const { return !splats_.empty(); }
    void want_splats();
    // The value must be countable. One thread at a time, beside those that add().
    void splat(const FilmSplat& splat);
    static bool is_countable(const FilmSplat& splat);
    // Counts light paths that have been followed.
    void count_light_paths(std::int64_t paths) { light_paths_ += paths; }
    std::int64_t light_paths() const { return light_paths_; }

    // Adds the samples of a film of the same size and channels. Throws Error{Input} otherwise, and
    // for more than 2^24 samples in a pixel.
    void merge(const Film& other);
    void clear();

    std::int64_t samples(int x, int y) const { return pixel(x, y).count; }
    std::int64_t total_samples() const;
    std::int64_t rejected() const;

    // Variance of the mean luminance of a pixel, from the spread of its samples as if they were
    // independent: an upper estimate for stratified ones. 0 below two samples.
    double variance(int x, int y) const;
    // The mean luminance of a pixel; 0 without samples.
    double mean_luminance(int x, int y) const;
    // Relative noise of the image: sqrt(mean variance of the pixel means) / mean luminance.
    // Infinity while no pixel has two samples, 0 for a black image.
    double noise() const;

    // R, G, B, A, Z and the extra channels. A pixel without samples is 0, its Z infinity.
    Image image() const;

    // All sums, pixel by pixel, rows from the top: for files.
    std::span<const FilmPixel> pixels() const { return pixels_; }
    std::span<FilmPixel> pixels() { return pixels_; }
    // Sums of weight * value, for each pixel one per extra channel.
    std::span<const ExactSum> extra_sums() const { return extra_; }
    std::span<ExactSum> extra_sums() { return extra_; }
    // Three for each pixel, or none.
    std::span<const ExactSum> splat_sums() const { return splats_; }
    std::span<ExactSum> splat_sums() { return splats_; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    const FilmPixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
    double divisor(const FilmPixel& p) const;
    double mean_of(const FilmPixel& p) const;
    double variance_of(const FilmPixel& p) const;

    int width_, height_;
    ReconstructionFilter filter_;
    std::vector<std::string> extra_names_;
    std::vector<FilmPixel> pixels_;
    std::vector<ExactSum> extra_;
    std::vector<ExactSum> splats_;
    std::int64_t light_paths_ = 0;
    double splat_norm_ = 1;  // one over the integral of the filter, 1/pixel^2
};

}  // namespace gischt
