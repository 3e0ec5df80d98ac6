// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "solve/stencil.h"

// The sweeps of the solver over tiles of one level, in SIMD for the machine that runs. Each takes
// part of the level's active tiles, as positions [begin, end) in StencilLevel::active, writes only
// to them, and reads ghosts, which fill_ghosts must have filled for fields read at neighbours.
// Fields are in split order; `d` is the inverse diagonal; `sum` and `largest` have one entry per
// active tile. Bytes per cell read + written, of the level's fields, stand beside each; a store to
// memory that was not read before counts twice.
namespace gischt {

struct TileRange {
    const StencilLevel& level;
    int begin, end;
};

// sum = p . A p. 4 bytes.
void multiply_sum(const TileRange& range, const SplitField& p, std::span<double> sum);

// x += step p (x in the user's order), r -= step A p, then red z = d r; largest = max|r|. 24 bytes.
void advance(const TileRange& range, float step, const SplitField& p, float* x, SplitField& r,
             SplitField& z, std::span<float> largest);

// sum = r . z. 8 bytes.
void dot(const TileRange& range, const SplitField& r, const SplitField& z, std::span<double> sum);

// largest = max|r|. 4 bytes.
void max_magnitude(const TileRange& range, const SplitField& r, std::span<float> largest);

// p = z + factor p. 12 bytes.
void direction(const TileRange& range, float factor, const SplitField& z, SplitField& p);

// First sweep of Gauss-Seidel from zero over the red cells: red z = d r. 6 bytes.
void smooth_red_first(const TileRange& range, const SplitField& r, SplitField& z);

// Gauss-Seidel on one colour: z = d (r + sum of w z over the neighbours); sum = (or += where `add`)
// r . z over the colour, where `sum` is not empty. 8 bytes.
struct Smooth {
    int color = 0;
    bool add = false;
};
void smooth(const TileRange& range, const Smooth& what, const SplitField& r, SplitField& z,
            std::span<double> sum);

// res = r - A z.
void residual(const TileRange& range, const SplitField& r, const SplitField& z, SplitField& res);

// After red and black were smoothed from zero the residual is zero on the black cells, and on the
// red ones sum of w z over the black neighbours, which this stores to red z. 6 bytes.
void red_residual(const TileRange& range, SplitField& z);

// The transfers between a level and the next coarser one, for a residual and a correction that
// matter on red cells only. P interpolates linearly along each axis on its own (Kwak 1999), with
// the open fraction w of the coarse face towards the neighbour n of the coarse cell c:
//   (P e)_child = e_c + 1/4 sum over the axes of w (e_n - e_c),
// exact for linear functions, never across walls, with face neighbours only; R is its transpose.
// The ranges are of the fine level.

// coarse r = R red res. 2.5 bytes of the fine level.
void restrict_red(const TileRange& fine, const StencilLevel& coarse, const SplitField& res,
                  SplitField& coarse_r);

// red z = d r + P e. 6.5 bytes of the fine level.
void prolong_red(const TileRange& fine, const StencilLevel& coarse, const SplitField& e,
                 const SplitField& r, SplitField& z);

// Changes between the user's order and split order; what is left out becomes zero.
void split(const TileRange& range, const float* natural, SplitField& field);

}  // namespace gischt
