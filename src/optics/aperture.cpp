// SPDX-License-Identifier: Apache-2.0
#include "optics/aperture.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace gischt {

static Vec2d disc_point(double u, double v) {
    const double x = 2 * u - 1, y = 2 * v - 1;
    if (x == 0 && y == 0) return {0, 0};
    const bool wide = std::abs(x) > std::abs(y);
    const double r = wide ? x : y;
    const double angle = wide ? pi / 4 * (y / x) : pi / 2 - pi / 4 * (x / y);
    return {r * std::cos(angle), r * std::sin(angle)};
}

Vec2d aperture_point(Vec2f u, int blades, double rotation) {
    const auto a = static_cast<double>(u.x), b = static_cast<double>(u.y);
    if (blades < 3) return disc_point(a, b);
    // One of the triangles from the centre to two corners, and a point of it.
    const double side = std::min(std::floor(a * blades), blades - 1.0), along = a * blades - side;
    const double out = std::sqrt(b), step = 2 * pi / blades;
    const double first = rotation + side * step, second = first + step;
    return {out * ((1 - along) * std::cos(first) + along * std::cos(second)),
            out * ((1 - along) * std::sin(first) + along * std::sin(second))};
}

}  // namespace gischt
