// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "grid/field.h"

namespace gischt {

// How a field on a box continues beyond its bounds on one side.
enum class Border {
    Clamp,     // the nearest value: zero gradient, the value of an open boundary
    Even,      // mirrored: free-slip wall for tangential velocity, insulated wall for scalars
    Odd,       // mirrored and negated: no-slip for tangential, solid wall for normal velocity
    Periodic,  // wraps around
    Zero,      // zero
};

// One rule per side of the box: -x, +x, -y, +y, -z, +z.
struct Borders {
    std::array<Border, 6> side{};

    static Borders all(Border b) { return {{b, b, b, b, b, b}}; }
    Border operator()(int axis, int end) const {
        return side[static_cast<std::size_t>(2 * axis + end)];
    }
};

// Copies the cells `region` (half-open, may reach beyond the bounds of the field's box map) to
// `out`, a dense array of region.size(), x fastest. A mirror at a wall maps cell -1 - m to m. The
// work is proportional to the region; most of it is row copies.
void gather(const TileField<float>& field, const Box3i& region, const Borders& borders, float* out);

// The same for component `axis` of a staggered field, region counting faces: along `axis` faces
// 0..n inclusive exist, and a mirror maps face -m to m (Odd keeps the wall's own value). Periodic:
// face n is face 0.
void gather_faces(const FaceField& field, int axis, const Box3i& region, const Borders& borders,
                  float* out);

}  // namespace gischt
