// SPDX-License-Identifier: Apache-2.0
#include "image/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "base/error.h"
#include "base/parallel.h"
#include "image/color.h"

namespace gischt {
namespace {

constexpr std::int64_t most_samples = 1 << 24;  // of a pixel: what an ExactSum holds

bool can_count(const FilmSample& s, std::span<const float> extra) {
    auto fits = [](float v) { return ExactSum::fits(static_cast<double>(v)); };
    return fits(s.radiance.x) && fits(s.radiance.y) && fits(s.radiance.z) && fits(s.alpha) &&
           (fits(s.depth) || (std::isinf(s.depth) && s.depth > 0)) &&
           std::all_of(extra.begin(), extra.end(), fits);
}

}  // namespace

Film::Film(int width, int height, ReconstructionFilter filter, std::vector<std::string> extra)
    : width_(width), height_(height), filter_(std::move(filter)), extra_names_(std::move(extra)) {
    const Image check(width, height, {});  // throws on a size that no image can have
    try {
        pixels_.resize(check.pixel_count());
        extra_.resize(check.pixel_count() * extra_names_.size());
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, "film",
                    fmt::format("no memory for {} x {} pixels", width, height),
                    "make the image smaller");
    }
}

void Film::add(int x, int y, const FilmSample& sample, std::span<const float> extra) {
    GISCHT_ASSERT(x >= 0 && y >= 0 && x < width_ && y < height_);
    GISCHT_ASSERT(extra.size() == extra_names_.size());
    GISCHT_ASSERT(std::abs(sample.weight) <= 1);
    FilmPixel& p = pixels_[index(x, y)];
    ++p.count;
    const double w = sample.weight;
    p.weight.add(w);
    if (!can_count(sample, extra)) {
        ++p.rejected;
        return;
    }
    const Vec3d radiance(sample.radiance);
    for (int c = 0; c < 3; ++c) p.radiance[c].add(w * radiance[c]);
    p.alpha.add(w * sample.alpha);
    const double y709 = gischt::luminance(radiance);
    p.luminance.add(y709);
    p.luminance_2.add(y709 * y709);
    if (std::isfinite(sample.depth)) {
        p.depth.add(sample.depth);
        ++p.hits;
    }
    ExactSum* sums = extra_.data() + index(x, y) * extra.size();
    for (std::size_t i = 0; i < extra.size(); ++i) sums[i].add(w * extra[i]);
}

// The integral of the filter by the midpoint rule, to about 1e-10.
void Film::want_splats() {
    if (has_splats()) return;
    splats_.resize(3 * pixels_.size());
    const double radius = filter_.radius();
    constexpr int parts = 1 << 16;
    double sum = 0;
    for (int i = 0; i < parts; ++i) sum += filter_.profile((i + 0.5) / parts * radius);
    const double line = 2 * sum * radius / parts;
    splat_norm_ = 1 / (line * line);
}

bool Film::is_countable(const FilmSplat& splat) {
    bool fits = std::abs(splat.at.x) < 1e6f && std::abs(splat.at.y) < 1e6f;
    for (int c = 0; c < 3; ++c) {
        fits = fits && ExactSum::fits(static_cast<double>(splat.value[c]));
    }
    return fits;
}

void Film::splat(const FilmSplat& splat) {
    GISCHT_ASSERT(has_splats());
    const double r = filter_.radius(), at_x = splat.at.x, at_y = splat.at.y;
    // A pixel's footprint is half open, so that boxes of radius 1/2 share no point.
    const auto first = [r](double x) { return static_cast<int>(std::floor(x - r - 0.5)) + 1; };
    const auto last = [r](double x) { return static_cast<int>(std::floor(x + r - 0.5)); };
    for (int y = std::max(first(at_y), 0); y <= std::min(last(at_y), height_ - 1); ++y) {
        const double across = splat_norm_ * filter_.profile(std::abs(at_y - y - 0.5));
        for (int x = std::max(first(at_x), 0); x <= std::min(last(at_x), width_ - 1); ++x) {
            const double share = across * filter_.profile(std::abs(at_x - x - 0.5));
            ExactSum* sums = splats_.data() + 3 * index(x, y);
            for (int c = 0; c < 3; ++c) sums[c].add(share * static_cast<double>(splat.value[c]));
        }
    }
}

void Film::merge(const Film& other) {
    if (other.has_splats() != has_splats()) {
        throw Error(ErrorKind::Input, "film", "only one of the films has a layer of light paths");
    }
    if (other.width_ != width_ || other.height_ != height_ || other.extra_names_ != extra_names_) {
        throw Error(ErrorKind::Input, "film",
                    fmt::format("cannot add {} x {} pixels to {} x {}, or their channels differ",
                                other.width_, other.height_, width_, height_));
    }
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        if (std::int64_t{pixels_[i].count} + other.pixels_[i].count > most_samples) {
            throw Error(ErrorKind::Input, "film", "a pixel would get more than 2^24 samples");
        }
    }
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        FilmPixel& p = pixels_[i];
        const FilmPixel& q = other.pixels_[i];
        for (int c = 0; c < 3; ++c) p.radiance[c].add(q.radiance[c]);
        p.alpha.add(q.alpha);
        p.weight.add(q.weight);
        p.luminance.add(q.luminance);
        p.depth.add(q.depth);
        p.luminance_2.add(q.luminance_2);
        p.hits += q.hits;
        p.count += q.count;
        p.rejected += q.rejected;
    }
    for (std::size_t i = 0; i < extra_.size(); ++i) extra_[i].add(other.extra_[i]);
    for (std::size_t i = 0; i < splats_.size(); ++i) splats_[i].add(other.splats_[i]);
    light_paths_ += other.light_paths_;
}

void Film::clear() {
    pixels_.assign(pixels_.size(), FilmPixel{});
    extra_.assign(extra_.size(), ExactSum{});
    splats_.assign(splats_.size(), ExactSum{});
    light_paths_ = 0;
}

std::int64_t Film::total_samples() const {
    std::int64_t sum = 0;
    for (const FilmPixel& p : pixels_) sum += p.count;
    return sum;
}

std::int64_t Film::rejected() const {
    std::int64_t sum = 0;
    for (const FilmPixel& p : pixels_) sum += p.rejected;
    return sum;
}

// The sum of the weights makes a constant radiance exact. With negative weights and few samples it
// can come near zero; then its expectation takes its place, which is noisier but harmless.
double Film::divisor(const FilmPixel& p) const {
    const double expected = p.count * filter_.mean_weight(), weight = p.weight.value();
    return weight >= 0.5 * expected ? weight : expected;
}

double Film::mean_of(const FilmPixel& p) const {
    if (p.count == 0) return 0;
    const Vec3d sum(p.radiance[0].value(), p.radiance[1].value(), p.radiance[2].value());
    return gischt::luminance(sum) / divisor(p);
}

// Mean m = sum(w y) / sum(w): its variance by linearization is n/(n-1) sum((w (y - m))^2) /
// sum(w)^2 (Cochran 1977, section 2.11), and w^2 = 1.
double Film::variance_of(const FilmPixel& p) const {
    if (p.count < 2) return 0;
    const double n = p.count, w = divisor(p), m = mean_of(p);
    const double squares =
        std::max(0.0, p.luminance_2.value() - 2 * m * p.luminance.value() + n * m * m);
    return n / (n - 1) * squares / (w * w);
}

double Film::variance(int x, int y) const {
    return variance_of(pixel(x, y));
}

double Film::mean_luminance(int x, int y) const {
    return mean_of(pixel(x, y));
}

double Film::noise() const {
    // Row by row, then a fixed tree: the same bits on any number of threads.
    std::vector<double> variances(static_cast<std::size_t>(height_)), means = variances;
    std::vector<double> known = variances;
    parallel_for(height_, 16, [&](int y) {
        const auto row = static_cast<std::size_t>(y);
        for (int x = 0; x < width_; ++x) {
            const FilmPixel& p = pixel(x, y);
            if (p.count < 2) continue;
            known[row] += 1;
            variances[row] += variance_of(p);
            means[row] += mean_of(p);
        }
    });
    const double count = tree_sum(known), mean = tree_sum(means);
    if (count == 0) return std::numeric_limits<double>::infinity();
    return mean > 0 ? std::sqrt(tree_sum(variances) / count) / (mean / count) : 0;
}

Image Film::image() const {
    Image out = Image::rgba(width_, height_);
    out.add_channel("Z");
    for (const std::string& name : extra_names_) out.add_channel(name);
    auto value = [&](std::size_t plane, std::size_t i) -> float& {
        return out.planes[plane].values[i];
    };
    const double per_pixel =
        light_paths_ > 0 ? static_cast<double>(pixels_.size()) / static_cast<double>(light_paths_)
                         : 0;
    parallel_for(height_, 16, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            const std::size_t i = index(x, y), extras = extra_names_.size();
            const FilmPixel& p = pixels_[i];
            const double scale = p.count > 0 ? 1 / divisor(p) : 0;
            for (int c = 0; c < 3; ++c) {
                double mean = p.radiance[c].value() * scale;
                if (has_splats()) {
                    mean += splats_[3 * i + static_cast<std::size_t>(c)].value() * per_pixel;
                }
                value(static_cast<std::size_t>(c), i) = static_cast<float>(mean);
            }
            value(3, i) = static_cast<float>(p.alpha.value() * scale);
            value(4, i) = p.hits > 0 ? static_cast<float>(p.depth.value() / p.hits)
                                     : std::numeric_limits<float>::infinity();
            for (std::size_t e = 0; e < extras; ++e) {
                value(5 + e, i) = static_cast<float>(extra_[i * extras + e].value() * scale);
            }
        }
    });
    return out;
}

}  // namespace gischt
