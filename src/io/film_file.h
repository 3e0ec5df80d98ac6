// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "image/film_state.h"
#include "image/image.h"

namespace gischt {

// A `.film` file: the sums of an unfinished (or finished) picture with what it takes to go on with
// it or to merge it. Exact: what was written comes back bit by bit.
//
//   "gischt film\n", then little-endian:
//   u32 version, u32 width, u32 height, u32 filter kind, f32 filter radius,
//   u32 count + strings (u32 length + bytes) of the extra channels,
//   u32 count + pairs of i32 of the sample ranges, u32 count + i32 of the tile goals, u8 flags,
//   u32 count + pairs of strings of the metadata;
//   per pixel, rows from the top: i32 count, hits, rejected as u32, then the sums of FilmPixel and
//   of the extra channels, each 128 bits, sign in the lowest bit, without the zero bytes at both
//   ends: a byte (bytes left out at the low end << 4 | bytes that follow - 1) and these bytes, or
//   255 for zero;
//   where bit 2 of the flags is set: i64 light paths, and three sums of splats for each pixel;
//   u64 FNV-1a of all that (base/hash.h).
//
// A 960x540 picture takes about 40 MB.
struct FilmFile {
    FilmState state;
    Metadata metadata;
};

// The state must hold a film. Throws what AtomicFile throws.
void write_film(const std::string& path, const FilmState& state, const Metadata& metadata);

// Throws Error{Input} for what is not such a file, of another version, truncated or damaged, and
// Error{Resource} when it does not fit into memory.
FilmFile read_film(const std::string& path);

// Whether the extension is .film.
bool is_film_file(const std::string& path);

}  // namespace gischt
