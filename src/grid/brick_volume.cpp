// SPDX-License-Identifier: Apache-2.0
#include "grid/brick_volume.h"

#include <algorithm>

namespace gischt {

std::size_t BrickVolume::bytes() const {
    return compact_.size() * sizeof(std::uint16_t) + full_.size() * sizeof(float) +
           (blocks_.size() + whole_.size()) * sizeof(Block) +
           coord_.size() * (sizeof(Vec3i) + sizeof(Vec2f) + 1) +
           (pages_.size() + table_.size()) * sizeof(std::int32_t);
}

double BrickVolume::cell_size() const {
    return std::min(
        {length(to_world_.column[0]), length(to_world_.column[1]), length(to_world_.column[2])});
}

Box3d BrickVolume::world_bounds() const {
    if (size() == 0) return Box3d::empty();
    return to_world_.bounds({Vec3d(support_.lo), Vec3d(support_.hi)});
}

int BrickVolume::find(const Vec3i& b) const {
    if (!brick_bounds_.contains(b)) return -1;
    const Vec3i p = Vec3i(b.x >> page_log, b.y >> page_log, b.z >> page_log) - page_box_.lo;
    const Vec3i n = page_box_.size();
    const auto page = pages_[static_cast<std::size_t>(p.x) +
                             static_cast<std::size_t>(n.x) *
                                 (static_cast<std::size_t>(p.y) +
                                  static_cast<std::size_t>(n.y) * static_cast<std::size_t>(p.z))];
    return table_[static_cast<std::size_t>(page) * page_size +
                  static_cast<std::size_t>((b.x & 7) + 8 * (b.y & 7) + 64 * (b.z & 7))];
}

float BrickVolume::at(const Vec3d& q) const {
    constexpr double scale = 1.0 / brick_edge;
    // A point too far away for an int is outside, whatever its brick.
    if (!(max_component(abs(q)) < 1e8)) return background_;
    const Vec3i b = floor(q * scale);
    const int brick = find(b);
    return brick < 0 ? background_ : at_local(brick, Vec3f(q - Vec3d(b) * double{brick_edge}));
}

}  // namespace gischt
