// SPDX-License-Identifier: Apache-2.0
#include "grid/gather.h"

#include <cstring>
#include <vector>

namespace gischt {
namespace {

// Where index `wanted` on one axis comes from: an index inside, and the factor of the value.
struct Source {
    int index;
    float sign;
};

// The axis has the indices 0..count - 1. Mirrors lie between -1 and 0 for cells, on index 0 and
// count - 1 for faces.
Source resolve(int wanted, int count, bool faces, Border low, Border high) {
    float sign = 1;
    int i = wanted;
    while (i < 0 || i >= count) {
        const Border border = i < 0 ? low : high;
        switch (border) {
            case Border::Clamp:
                return {i < 0 ? 0 : count - 1, sign};
            case Border::Zero:
                return {0, 0.0f};
            case Border::Periodic: {
                const int period = faces ? count - 1 : count;
                i = ((i % period) + period) % period;
                break;
            }
            case Border::Even:
            case Border::Odd:
                if (border == Border::Odd) sign = -sign;
                i = i < 0 ? (faces ? -i : -1 - i)
                          : (faces ? 2 * (count - 1) - i : 2 * count - 1 - i);
                break;
        }
    }
    return {i, sign};
}

// Copies cells of one row [x0, x0 + n) that exist, tile by tile.
void copy_row(const TileField<float>& f, int x0, int n, int y, int z, float* out) {
    const TileMap& map = f.map();
    const TileShape& s = map.shape();
    const Vec3i extent = s.extent();
    while (n > 0) {
        const int local = x0 & (extent.x - 1), count = std::min(n, extent.x - local);
        const int t = map.find(s.tile_of({x0, y, z}));
        const float* row = f.tile(t) + s.index(local, y & (extent.y - 1), z & (extent.z - 1));
        std::memcpy(out, row, sizeof(float) * static_cast<std::size_t>(count));
        x0 += count;
        out += count;
        n -= count;
    }
}

using Sources = std::array<std::vector<Source>, 3>;

Sources resolve_region(const Box3i& region, const Vec3i& count, int face_axis,
                       const Borders& borders) {
    Sources sources;
    for (int a = 0; a < 3; ++a) {
        auto& list = sources[static_cast<std::size_t>(a)];
        for (int i = region.lo[a]; i < region.hi[a]; ++i) {
            list.push_back(resolve(i, count[a], a == face_axis, borders(a, 0), borders(a, 1)));
        }
    }
    return sources;
}

// General case: every index of the region is resolved, `value(i, j, k)` reads an existing one; rows
// run along x.
template <class Row>
void gather_resolved(const Box3i& region, const Sources& from, int row_count, Row&& copy,
                     float* out) {
    const Vec3i n = region.size();
    // The part of each row that exists as it is can be copied in one go.
    const int inside_lo = std::clamp(region.lo.x, 0, row_count),
              inside_hi = std::clamp(region.hi.x, 0, row_count);
    for (int k = 0; k < n.z; ++k) {
        for (int j = 0; j < n.y; ++j, out += n.x) {
            const Source sy = from[1][static_cast<std::size_t>(j)],
                         sz = from[2][static_cast<std::size_t>(k)];
            const float sign = sy.sign * sz.sign;
            if (inside_lo < inside_hi)
                copy(inside_lo, inside_hi - inside_lo, sy.index, sz.index,
                     out + (inside_lo - region.lo.x));
            for (int i = 0; i < n.x; ++i) {
                const int x = region.lo.x + i;
                if (x >= inside_lo && x < inside_hi) continue;
                const Source sx = from[0][static_cast<std::size_t>(i)];
                copy(sx.index, 1, sy.index, sz.index, out + i);
                out[i] *= sx.sign;
            }
            if (sign != 1) {
                for (int i = 0; i < n.x; ++i) out[i] *= sign;
            }
        }
    }
}

// Region of existing cells only: whole runs of tile rows, one tile look-up per tile.
void gather_inside(const TileField<float>& f, const Box3i& region, float* out) {
    const TileMap& map = f.map();
    const TileShape& s = map.shape();
    const Vec3i first = s.tile_of(region.lo), last = s.tile_of(region.hi - Vec3i(1)),
                n = region.size();
    for (int tz = first.z; tz <= last.z; ++tz) {
        for (int ty = first.y; ty <= last.y; ++ty) {
            for (int tx = first.x; tx <= last.x; ++tx) {
                const int t = map.find({tx, ty, tz});
                const Vec3i corner{tx << s.log_x, ty << s.log_y, tz << s.log_z};
                const Box3i part = intersection(region, Box3i{corner, corner + s.extent()});
                const Vec3i size = part.size(), from = part.lo - corner, to = part.lo - region.lo;
                for (int k = 0; k < size.z; ++k) {
                    for (int j = 0; j < size.y; ++j) {
                        const float* src = f.tile(t) + s.index(from.x, from.y + j, from.z + k);
                        float* dst = out + to.x + n.x * (to.y + j + n.y * (to.z + k));
                        for (int i = 0; i < size.x; ++i) dst[i] = src[i];
                    }
                }
            }
        }
    }
}

bool is_inside(const Box3i& region, const Vec3i& n) {
    return min_component(region.lo) >= 0 && region.hi.x <= n.x && region.hi.y <= n.y &&
           region.hi.z <= n.z;
}

}  // namespace

void gather(const TileField<float>& field, const Box3i& region, const Borders& borders,
            float* out) {
    const Vec3i n = field.map().bounds().size();
    if (is_inside(region, n)) return gather_inside(field, region, out);
    const Sources from = resolve_region(region, n, -1, borders);
    gather_resolved(
        region, from, n.x,
        [&](int x, int count, int y, int z, float* to) { copy_row(field, x, count, y, z, to); },
        out);
}

void gather_faces(const FaceField& field, int axis, const Box3i& region, const Borders& borders,
                  float* out) {
    const TileField<float>& f = field[axis];
    const Vec3i n = field.map().bounds().size();
    if (is_inside(region, n)) return gather_inside(f, region, out);
    Vec3i count = n;
    count[axis] += 1;
    const Sources from = resolve_region(region, count, axis, borders);
    const auto& last = field.last[static_cast<std::size_t>(axis)];
    gather_resolved(
        region, from, count.x,
        [&](int x, int run, int y, int z, float* to) {
            if (axis != 0) {
                const Vec3i face{x, y, z};
                if (face[axis] < n[axis]) return copy_row(f, x, run, y, z, to);
                for (int i = 0; i < run; ++i) to[i] = last[field.last_index(axis, {x + i, y, z})];
            } else {
                const int in_tiles = std::min(run, n.x - x);
                if (in_tiles > 0) copy_row(f, x, in_tiles, y, z, to);
                if (in_tiles < run) to[run - 1] = last[field.last_index(0, {n.x, y, z})];
            }
        },
        out);
}

}  // namespace gischt
