// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "image/filter.h"
#include "image/image.h"
#include "math/vec.h"

namespace gischt {

// What one sample of a pixel measured.
struct FilmSample {
    Vec3f radiance;   // W/(m^2 sr), Rec.709, premultiplied by alpha
    float alpha = 1;  // coverage
    float depth = std::numeric_limits<float>::infinity();  // metres; infinity where nothing was hit
    float weight = 1;                                      // of FilterSample
};

// Adds up the samples of every pixel in double precision. Use:
//   const FilterSample f = film.sample_filter(u);
//   ... trace through (x + 0.5 + f.offset.x, y + 0.5 + f.offset.y) ...
//   film.add(x, y, {radiance, alpha, depth, f.weight});
// Different pixels may be added to by different threads at once; one pixel by one thread at a time,
// in an order of samples that the caller keeps, so that the bits do not depend on the threads.
class Film {
  public:
    // `extra` names further channels, such as "direct.R" or "samples". Throws as Image does.
    Film(int width, int height, ReconstructionFilter filter = ReconstructionFilter(),
         std::vector<std::string> extra = {});

    int width() const { return width_; }
    int height() const { return height_; }
    const ReconstructionFilter& filter() const { return filter_; }
    FilterSample sample_filter(Vec2f u) const { return filter_.sample(u); }

    // `extra` holds one value per extra channel. A sample that is not finite (depth aside) counts
    // as black and is reported by rejected().
    void add(int x, int y, const FilmSample& sample, std::span<const float> extra = {});
    // Adds the samples of a film of the same size and channels. Throws Error{Input} otherwise.
    void merge(const Film& other);
    void clear();

    std::int64_t samples(int x, int y) const { return pixel(x, y).count; }
    std::int64_t total_samples() const;
    std::int64_t rejected() const;

    // Variance of the mean luminance of a pixel, from the spread of its samples as if they were
    // independent: an upper estimate for stratified ones. 0 below two samples.
    double variance(int x, int y) const;
    // Relative noise of the image: sqrt(mean variance of the pixel means) / mean luminance.
    // Infinity while no pixel has two samples, 0 for a black image.
    double noise() const;

    // R, G, B, A, Z and the extra channels. A pixel without samples is 0, its Z infinity.
    Image image() const;

  private:
    struct Pixel {
        Vec3d radiance;                         // sums of weight * value
        double alpha = 0, weight = 0;           //
        double luminance = 0, luminance_2 = 0;  // sums of value and value^2, without weight
        double depth = 0;                       // sum over the samples that hit something
        std::int32_t hits = 0, count = 0, rejected = 0;
    };
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
    double divisor(const Pixel& p) const;
    double variance_of(const Pixel& p) const;

    int width_, height_;
    ReconstructionFilter filter_;
    std::vector<std::string> extra_names_;
    std::vector<Pixel> pixels_;
    std::vector<double> extra_;  // pixel by pixel, one sum of weight * value per extra channel
};

}  // namespace gischt
