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

bool is_finite(const FilmSample& s) {
    return std::isfinite(s.radiance.x) && std::isfinite(s.radiance.y) &&
           std::isfinite(s.radiance.z) && std::isfinite(s.alpha) && std::isfinite(s.weight);
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
    Pixel& p = pixels_[index(x, y)];
    ++p.count;
    if (!is_finite(sample)) {
        ++p.rejected;
        p.weight += std::isfinite(sample.weight) ? sample.weight : 1;
        return;
    }
    const double w = sample.weight;
    const Vec3d radiance(sample.radiance);
    p.radiance += w * radiance;
    p.alpha += w * sample.alpha;
    p.weight += w;
    const double y709 = gischt::luminance(radiance);
    p.luminance += y709;
    p.luminance_2 += y709 * y709;
    if (std::isfinite(sample.depth)) {
        p.depth += sample.depth;
        ++p.hits;
    }
    double* sums = extra_.data() + index(x, y) * extra.size();
    for (std::size_t i = 0; i < extra.size(); ++i) sums[i] += w * extra[i];
}

void Film::merge(const Film& other) {
    if (other.width_ != width_ || other.height_ != height_ || other.extra_names_ != extra_names_) {
        throw Error(ErrorKind::Input, "film",
                    fmt::format("cannot add {} x {} pixels to {} x {}, or their channels differ",
                                other.width_, other.height_, width_, height_));
    }
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        const Pixel& q = other.pixels_[i];
        p.radiance += q.radiance;
        p.alpha += q.alpha;
        p.weight += q.weight;
        p.luminance += q.luminance;
        p.luminance_2 += q.luminance_2;
        p.depth += q.depth;
        p.hits += q.hits;
        p.count += q.count;
        p.rejected += q.rejected;
    }
    for (std::size_t i = 0; i < extra_.size(); ++i) extra_[i] += other.extra_[i];
}

void Film::clear() {
    pixels_.assign(pixels_.size(), Pixel{});
    extra_.assign(extra_.size(), 0.0);
}

std::int64_t Film::total_samples() const {
    std::int64_t sum = 0;
    for (const Pixel& p : pixels_) sum += p.count;
    return sum;
}

std::int64_t Film::rejected() const {
    std::int64_t sum = 0;
    for (const Pixel& p : pixels_) sum += p.rejected;
    return sum;
}

// The sum of the weights makes a constant radiance exact. With negative weights and few samples it
// can come near zero; then its expectation takes its place, which is noisier but harmless.
double Film::divisor(const Pixel& p) const {
    const double expected = p.count * filter_.mean_weight();
    return p.weight >= 0.5 * expected ? p.weight : expected;
}

// Mean m = sum(w y) / sum(w): its variance by linearization is n/(n-1) sum((w (y - m))^2) /
// sum(w)^2 (Cochran 1977, section 2.11), and w^2 = 1.
double Film::variance_of(const Pixel& p) const {
    if (p.count < 2) return 0;
    const double n = p.count, w = divisor(p), m = gischt::luminance(p.radiance) / w;
    const double squares = std::max(0.0, p.luminance_2 - 2 * m * p.luminance + n * m * m);
    return n / (n - 1) * squares / (w * w);
}

double Film::variance(int x, int y) const {
    return variance_of(pixel(x, y));
}

double Film::noise() const {
    // Row by row, then a fixed tree: the same bits on any number of threads.
    std::vector<double> variances(static_cast<std::size_t>(height_)), means = variances;
    std::vector<double> known = variances;
    parallel_for(height_, 16, [&](int y) {
        const auto row = static_cast<std::size_t>(y);
        for (int x = 0; x < width_; ++x) {
            const Pixel& p = pixel(x, y);
            if (p.count < 2) continue;
            known[row] += 1;
            variances[row] += variance_of(p);
            means[row] += gischt::luminance(p.radiance) / divisor(p);
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
    parallel_for(height_, 16, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            const std::size_t i = index(x, y), extras = extra_names_.size();
            const Pixel& p = pixels_[i];
            const double scale = p.count > 0 ? 1 / divisor(p) : 0;
            for (int c = 0; c < 3; ++c) {
                value(static_cast<std::size_t>(c), i) = static_cast<float>(p.radiance[c] * scale);
            }
            value(3, i) = static_cast<float>(p.alpha * scale);
            value(4, i) = p.hits > 0 ? static_cast<float>(p.depth / p.hits)
                                     : std::numeric_limits<float>::infinity();
            for (std::size_t e = 0; e < extras; ++e) {
                value(5 + e, i) = static_cast<float>(extra_[i * extras + e] * scale);
            }
        }
    });
    return out;
}

}  // namespace gischt
