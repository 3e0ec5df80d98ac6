// SPDX-License-Identifier: Apache-2.0
#include "image/film_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "image/coarse_fill.h"

namespace gischt {
namespace {

bool same_filter(const ReconstructionFilter& a, const ReconstructionFilter& b) {
    return a.kind() == b.kind() && a.radius() == b.radius();
}

// Both lists in one, ascending, neighbours joined. Throws where they overlap.
std::vector<SampleRange> united(std::vector<SampleRange> ranges,
                                const std::vector<SampleRange>& more) {
    ranges.insert(ranges.end(), more.begin(), more.end());
    std::sort(ranges.begin(), ranges.end(),
              [](SampleRange a, SampleRange b) { return a.begin < b.begin; });
    std::vector<SampleRange> out;
    for (const SampleRange r : ranges) {
        if (!out.empty() && r.begin < out.back().end) {
            throw Error(ErrorKind::Input, "film",
                        fmt::format("the samples {}:{} would count twice", r.begin,
                                    std::min(r.end, out.back().end)),
                        "render the parts with different --samples");
        }
        if (!out.empty() && r.begin == out.back().end)
            out.back().end = r.end;
        else
            out.push_back(r);
    }
    return out;
}

}  // namespace

bool FilmState::is_complete() const {
    if (!film) return false;
    std::int64_t all = 0;
    for (const SampleRange r : ranges) all += r.end - r.begin;
    return std::all_of(film->pixels().begin(), film->pixels().end(),
                       [&](const FilmPixel& p) { return p.count == all; });
}

Image FilmState::image() const {
    Image out = film->image();
    fill_coarse(*film, out);
    if (has_variance) {
        const std::span<float> plane = out.add_channel("variance.Y");
        for (int y = 0; y < out.height; ++y) {
            for (int x = 0; x < out.width; ++x) {
                plane[out.index(x, y)] = static_cast<float>(film->variance(x, y));
            }
        }
    }
    if (has_samples) {
        const std::span<float> plane = out.add_channel("samples.Y");
        for (int y = 0; y < out.height; ++y) {
            for (int x = 0; x < out.width; ++x) {
                plane[out.index(x, y)] = static_cast<float>(film->samples(x, y));
            }
        }
    }
    return out;
}

void FilmState::merge(const FilmState& other) {
    std::vector<SampleRange> all = united(ranges, other.ranges);
    if (!same_filter(film->filter(), other.film->filter())) {
        throw Error(ErrorKind::Input, "film", "the reconstruction filters differ");
    }
    film->merge(*other.film);
    ranges = std::move(all);
    has_variance = has_variance || other.has_variance;
    has_samples = has_samples || other.has_samples;
    tile_goals.clear();
}

std::string to_text(const std::vector<SampleRange>& ranges) {
    std::string text;
    for (const SampleRange r : ranges) {
        text += fmt::format("{}{}:{}", text.empty() ? "" : ", ", r.begin, r.end);
    }
    return text;
}

}  // namespace gischt
