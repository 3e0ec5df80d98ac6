// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "image/film.h"

namespace gischt {

// Indices of samples, [begin, end).
struct SampleRange {
    int begin = 0, end = 0;
    bool operator==(const SampleRange&) const = default;
};

// A film that may be unfinished, with what it takes to go on with it or to merge it.
struct FilmState {
    std::optional<Film> film;
    // Which samples are in it: ascending, disjoint, not touching. Where the work was cut short or
    // the picture sampled adaptively, some pixels have only the first ones of a range.
    std::vector<SampleRange> ranges;
    // Samples that the pixels of each tile shall have when the pass is over, as the loop of
    // render/progressive.h wants it. Empty after a merge: then the film can be gone on with when
    // it is complete, else nobody knows which samples a pixel lacks.
    std::vector<std::int32_t> tile_goals;
    // Layers of the picture that come from the film itself.
    bool has_variance = false, has_samples = false;

    // Whether every pixel has all samples of the ranges.
    bool is_complete() const;
    // The film's picture, with variance.Y and samples.Y where they are wanted. While
    // pixels lack their first sample it is made of the samples around (see coarse_fill.h).
    Image image() const;
    // Adds the samples of another. Throws Error{Input} when ranges overlap or the films differ in
    // size, filter or channels.
    void merge(const FilmState& other);
};

// "0:16, 32:48"
std::string to_text(const std::vector<SampleRange>& ranges);

}  // namespace gischt
