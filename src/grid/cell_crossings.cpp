// SPDX-License-Identifier: Apache-2.0
#include "grid/cell_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gischt {

int max_crossings(const Vec3f& step, float length) {
    const Vec3f cells = length * abs(step);
    return static_cast<int>(cells.x) + static_cast<int>(cells.y) + static_cast<int>(cells.z) + 3;
}

int cell_crossings(const Vec3f& entry, const Vec3f& step, float length, std::span<float> out) {
    constexpr float never = std::numeric_limits<float>::infinity();
    std::array<float, 3> next, spacing;
    for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(a);
        const float rate = std::abs(step[a]);
        if (!(rate * length > 1e-6f)) {
            next[i] = spacing[i] = never;
            continue;
        }
        spacing[i] = 1 / rate;
        // Cells to go until the first plane, in ]0, 1].
        const float to_go =
            step[a] > 0 ? std::floor(entry[a]) + 1 - entry[a] : entry[a] - std::ceil(entry[a]) + 1;
        next[i] = to_go * spacing[i];
    }
    // Merges the three arithmetic sequences.
    int count = 0;
    for (;;) {
        const float t = std::min({next[0], next[1], next[2]});
        if (!(t < length) || count == static_cast<int>(out.size())) return count;
        out[static_cast<std::size_t>(count++)] = t;
        for (std::size_t i = 0; i < 3; ++i) {
            if (next[i] <= t) next[i] += spacing[i];
        }
    }
}

}  // namespace gischt
