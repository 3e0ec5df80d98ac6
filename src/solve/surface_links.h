// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grid/gather.h"

namespace gischt {

// What is known of solids at the unknowns of a tile and one layer around them (in 2-D none along
// z): a dense array over `cells`, x fastest.
struct TileSurroundings {
    Box3i cells;
    std::vector<float> distance;  // > 0: fluid
    std::vector<float> value;     // that the solid holds there; empty: zero

    bool is_open() const;
};

// The coefficients that solids leave to a diffusing quantity: nothing flows between an unknown and
// a neighbour inside. Where the solid holds a value, the unknown is bound to it by `extra` =
// 1 / theta, theta being the share of the way at which the surface lies (Gibou, Fedkiw, Cheng, Kang
// 2002), and by `hold` = extra times the value there.
class SurfaceLinks {
  public:
    FaceField weight;  // 1, or what the caller puts before link(), but 0 at solids
    TileField<float> extra, hold;

    // `borders`: Periodic, or anything else where the side's own rule holds. `holds`: else solids
    // are only not felt.
    SurfaceLinks(const TileMap::Ptr& map, const Borders& borders, bool holds);

    // Tiles may be linked on several threads, each once.
    void link(int tile, const TileSurroundings& around);

    // Adds what is held to a right-hand side. Returns the factor, at most 1, for a tolerance that
    // is relative to its largest value: stiff links must not make it coarse for the rest.
    double add_held(TileField<float>& right_hand_side) const;

  private:
    Borders borders_;
    bool holds_;
};

}  // namespace gischt
