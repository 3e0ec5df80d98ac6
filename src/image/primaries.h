// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/transform.h"
#include "math/vec.h"

namespace gischt {

// CIE 1931 chromaticities (x, y) of a color space's red, green, blue and white.
struct Primaries {
    Vec2d red, green, blue, white;
};

inline constexpr Primaries rec709_primaries{
    {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

// Matrix from linear RGB to XYZ, Y of white being 1 (SMPTE RP 177). The translation is zero.
Transform rgb_to_xyz(const Primaries& p);

// Matrix from one linear RGB to another; white stays white (von Kries in the Bradford cone space,
// Lam 1985).
Transform convert_primaries(const Primaries& from, const Primaries& to);

}  // namespace gischt
