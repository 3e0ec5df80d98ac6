// SPDX-License-Identifier: Apache-2.0
#include "fluid/ghosts.h"

#include "fluid/block.h"

namespace gischt {
namespace {

template <class F>
void for_neighbours(const Box3i& box, const Vec3i& p, F&& f) {
    for (int a = 0; a < 3; ++a) {
        for (const int side : {-1, 1}) {
            Vec3i q = p;
            q[a] += side;
            if (box.contains(q)) f(q);
        }
    }
}

}  // namespace

void Ghosts::find(const TileMap& map, int axis, const Box3i& region, int layers,
                  const std::function<bool(const Vec3i&)>& is_covered) {
    points_.clear();
    deep_.clear();
    rules_.clear();
    layer_end_.clear();
    if (region.is_empty()) return;
    const Vec3i n = region.size();
    // The layer of each point; fluid is 0, what has none yet is `unknown`.
    constexpr int unknown = 1 << 20;
    std::vector<int> layer(volume(n));
    const auto layer_of = [&](const Vec3i& p) -> int& {
        const Vec3i d = p - region.lo;
        return layer[static_cast<std::size_t>(d.x) +
                     static_cast<std::size_t>(n.x) *
                         (static_cast<std::size_t>(d.y) +
                          static_cast<std::size_t>(n.y) * static_cast<std::size_t>(d.z))];
    };
    parallel_for(n.z, 1, [&](int k) {
        Box3i slab = region;
        slab.lo.z += k;
        slab.hi.z = slab.lo.z + 1;
        for_cells(slab, [&](const Vec3i& p) { layer_of(p) = is_covered(p) ? unknown : 0; });
    });

    // Layer 1 touches the fluid, layer n + 1 touches layer n.
    std::vector<Vec3i> front, next;
    for_cells(region, [&](const Vec3i& p) {
        bool touches = false;
        for_neighbours(region, p, [&](const Vec3i& q) { touches |= layer_of(q) == 0; });
        if (layer_of(p) == unknown && touches) next.push_back(p);
    });
    const Vec3i cells = map.bounds().size();
    const auto flat = [&](const Vec3i& p) {
        if (axis >= 0 && p[axis] == cells[axis]) {
            const int i = axis == 0   ? p.y + cells.y * p.z
                          : axis == 1 ? p.x + cells.x * p.z
                                      : p.x + cells.x * p.y;
            return static_cast<std::size_t>(map.size()) * tile_values + static_cast<std::size_t>(i);
        }
        const TileShape s = map.shape();
        const int t = map.find(s.tile_of(p));
        const Vec3i local = p - map.first_cell(t);
        return static_cast<std::size_t>(t) * tile_values +
               static_cast<std::size_t>(s.index(local.x, local.y, local.z));
    };
    for (int l = 1; l <= layers && !next.empty(); ++l) {
        front.swap(next);
        next.clear();
        for (const Vec3i& p : front) layer_of(p) = l;
        for (const Vec3i& p : front) {
            Rule rule{flat(p)};
            for_neighbours(region, p, [&](const Vec3i& q) {
                if (layer_of(q) < l) rule.from[static_cast<std::size_t>(rule.count++)] = flat(q);
                if (layer_of(q) == unknown) {
                    layer_of(q) = unknown + 1;  // listed
                    next.push_back(q);
                }
            });
            points_.push_back(p);
            rules_.push_back(rule);
        }
        layer_end_.push_back(rules_.size());
    }
    for_cells(region, [&](const Vec3i& p) {
        if (layer_of(p) >= unknown) deep_.push_back(p);
    });
}

void Ghosts::extrapolate(TileField<float>& values, AlignedVector<float>* last) const {
    const std::size_t count = values.values().size();
    const auto at = [&](std::size_t i) -> float& {
        return i < count ? values.values()[i] : (*last)[i - count];
    };
    std::size_t begin = 0;
    for (const std::size_t end : layer_end_) {
        parallel_for(static_cast<int>(end - begin), 1024, [&](int i) {
            const Rule& rule = rules_[begin + static_cast<std::size_t>(i)];
            float sum = 0;
            for (int n = 0; n < rule.count; ++n) sum += at(rule.from[static_cast<std::size_t>(n)]);
            at(rule.target) = sum / static_cast<float>(rule.count);
        });
        begin = end;
    }
}

}  // namespace gischt
