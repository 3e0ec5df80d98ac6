// SPDX-License-Identifier: Apache-2.0
#include "render/march/irradiance_map.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "math/sobol.h"

namespace gischt {
namespace {

constexpr int columns = 48, rows = 24;  // intervals; both divisible by 4 for the axes
constexpr int directions = 4096;

struct Beam {
    Vec3f direction, weight;
};

std::vector<Beam> beams_of(const Light& light) {
    std::vector<Beam> beams;
    for (int i = 0; i < directions; ++i) {
        const LightSample s = light.sample({}, sobol_2d(static_cast<std::uint32_t>(i), 1));
        if (max_component(s.weight) <= 0) continue;
        beams.push_back({Vec3f(s.direction), s.weight * (1.0f / directions)});
    }
    return beams;
}

}  // namespace

IrradianceMap::IrradianceMap(const Light& light) : nodes_(columns * (rows + 1)) {
    const std::vector<Beam> beams = beams_of(light);
    parallel_for(rows + 1, 1, [&](int row) {
        const double polar = pi * row / rows;
        for (int column = 0; column < columns; ++column) {
            const double turn = 2 * pi * column / columns;
            const Vec3f normal(Vec3d(std::sin(polar) * std::cos(turn),
                                     std::sin(polar) * std::sin(turn), std::cos(polar)));
            Vec3f sum;
            for (const Beam& b : beams) sum += std::max(0.0f, dot(b.direction, normal)) * b.weight;
            nodes_[static_cast<std::size_t>(row * columns + column)] = sum;
        }
    });
}

Vec3f IrradianceMap::operator()(const Vec3d& normal) const {
    const double turn = std::atan2(normal.y, normal.x) / (2 * pi);
    const double x = (turn < 0 ? turn + 1 : turn) * columns,
                 y = std::acos(std::clamp(normal.z, -1.0, 1.0)) / pi * rows;
    const int i = static_cast<int>(x), j = std::min(static_cast<int>(y), rows - 1);
    const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
    const auto node = [&](int column, int row) {
        return nodes_[static_cast<std::size_t>(row * columns + column % columns)];
    };
    return (1 - t) * ((1 - s) * node(i, j) + s * node(i + 1, j)) +
           t * ((1 - s) * node(i, j + 1) + s * node(i + 1, j + 1));
}

}  // namespace gischt
