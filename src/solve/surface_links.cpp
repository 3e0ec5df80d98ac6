// SPDX-License-Identifier: Apache-2.0
#include "solve/surface_links.h"

#include <algorithm>

namespace gischt {
namespace {

// Nearer surfaces are taken to be this far, in cells: a stiffer link would cost float its digits.
constexpr float least_theta = 0.01f;

}  // namespace

bool TileSurroundings::is_open() const {
    return std::ranges::all_of(distance, [](float d) { return d > 0; });
}

SurfaceLinks::SurfaceLinks(const TileMap::Ptr& map, const Borders& borders, bool holds)
    : weight(map, 1), extra(map), hold(map), borders_(borders), holds_(holds) {}

void SurfaceLinks::link(int tile, const TileSurroundings& around) {
    const TileMap& map = extra.map();
    const Vec3i size = around.cells.size(), count = map.bounds().size(),
                first = map.first_cell(tile);
    const auto at = [&](const Vec3i& cell) {
        const Vec3i c = cell - around.cells.lo;
        return static_cast<std::size_t>(c.x + size.x * (c.y + size.y * c.z));
    };
    const auto visit = [&](const Vec3i& cell) {
        const Vec3i local = cell - first;
        const int v = map.shape().index(local.x, local.y, local.z);
        const std::size_t i = at(cell);
        const bool closed = !(around.distance[i] > 0);
        for (int a = 0; a < weight.axes(); ++a) {
            for (int end = 0; end < 2; ++end) {
                Vec3i next = cell;
                next[a] += end == 0 ? -1 : 1;
                const bool is_side = cell[a] == (end == 0 ? 0 : count[a] - 1);
                const bool beyond = is_side && borders_(a, end) != Border::Periodic;
                const bool next_closed = !beyond && !(around.distance[at(next)] > 0);
                if (!closed && next_closed && holds_) {
                    const std::size_t j = at(next);
                    const float theta =
                        std::max(around.distance[i] / (around.distance[i] - around.distance[j]),
                                 least_theta);
                    extra.tile(tile)[v] += 1 / theta;
                    if (!around.value.empty()) {
                        const float held = (1 - theta) * around.value[i] + theta * around.value[j];
                        hold.tile(tile)[v] += held / theta;
                    }
                }
                if (!closed && !next_closed) continue;
                if (end == 0) weight[a].tile(tile)[v] = 0;
                if (end == 1 && is_side) {
                    weight.last[static_cast<std::size_t>(a)][weight.last_index(a, cell)] = 0;
                }
            }
        }
    };
    const Box3i cells = map.cells_of(tile);
    for (int k = cells.lo.z; k < cells.hi.z; ++k) {
        for (int j = cells.lo.y; j < cells.hi.y; ++j) {
            for (int i = cells.lo.x; i < cells.hi.x; ++i) visit({i, j, k});
        }
    }
}

double SurfaceLinks::add_held(TileField<float>& right_hand_side) const {
    auto& b = right_hand_side.values();
    const auto &held = hold.values(), &stiff = extra.values();
    float stiffest = 1;
    for (std::size_t i = 0; i < b.size(); ++i) {
        if (held[i] == 0) continue;
        b[i] += held[i];
        stiffest = std::max(stiffest, stiff[i]);
    }
    return static_cast<double>(1 / stiffest);
}

}  // namespace gischt
