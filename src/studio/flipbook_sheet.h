// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/image.h"
#include "math/vec.h"

namespace gischt {

// Where the cells of a sprite sheet lie: row by row, the first one top left.
struct SheetLayout {
    int columns = 1, rows = 1;
    int cell_width = 128, cell_height = 128;  // pixels

    int cells() const { return columns * rows; }
    int width() const { return columns * cell_width; }
    int height() const { return rows * cell_height; }
    // Top left pixel of a cell.
    Vec2i corner(int cell) const {
        return {cell % columns * cell_width, cell / columns * cell_height};
    }
};

// Wider textures are beyond what graphics hardware takes (the limit of Direct3D 11 and 12).
inline constexpr int widest_sheet = 16384;  // pixels

// The grid whose sheet is closest to a square with room for so many cells. Throws what check_sheet
// throws.
SheetLayout square_sheet(int cells, Vec2i cell);
// Throws Error{Usage} for sizes below 1, sheets wider or higher than widest_sheet, and grids with
// fewer cells than needed.
void check_sheet(const SheetLayout& layout, int cells);

// The cell to which a rendered frame goes, and how much of it.
struct CellShare {
    int cell = 0;
    float weight = 1;
};
// A loop of frames - loop cells from so many frames. Cell 0 shows frame `loop`; the last `loop`
// cells fade from the last frames over to those before that frame:
//   cell M - N + j = (1 - w) frame M + j + w frame j,   w = (j + 1) / (N + 1),
// M cells, N = loop, j = 0 ... N - 1. So the step from the last cell to the first is that from
// frame N - 1 to frame N, but for 1 / (N + 1) of the fade, as is each step of the fade.
CellShare cell_share(int frame, int frames, int loop);
// Throws Error{Usage} unless 0 <= loop and there are at least twice as many frames.
void check_loop(int frames, int loop);

// Adds weight times the channels of `part`, a picture of a cell's size, that the sheet has too.
void add_cell(Image& sheet, const SheetLayout& layout, int cell, const Image& part, float weight);

// A texel with less coverage is invisible at 8 bits: less than half a code.
inline constexpr float least_coverage = 0.5f / 255;

// Divides all channels by the coverage A, which stays. Texels below least_coverage take what lies
// next to them in their cell, so that a filtering texture unit mixes no black into the edge of a
// sprite. A cell without coverage becomes 0.
void make_straight(Image& sheet, const SheetLayout& layout);

// Light that has more than its coverage, a flame without soot, gets the coverage that can carry it:
// A = max(A, factor * largest channel of `glow`), at most 1. Premultiplied, both of one size.
void carry_glow(Image& sheet, const Image& glow, float factor);

// The six directions from which light maps are lit, as the camera sees them; `back` lies behind
// the fluid and `front` on the side of the camera.
inline constexpr const char* light_sides[6] = {"right", "top", "back", "left", "bottom", "front"};

// Six-way light maps in the packing of Unity's "Six Way Smoke Lit" shader, from a sheet with
// channels light_sides and A: R, G, B are right, top, back and A the transparency; R, G, B are
// left, bottom, front and A what glows. `glow` may be null; its luminance is divided by
// `glow_scale`.
Image pack_light_a(const Image& light);
Image pack_light_b(const Image& light, const Image* glow, float glow_scale);

}  // namespace gischt
