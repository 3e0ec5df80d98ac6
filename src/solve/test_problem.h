// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "solve/poisson.h"

// Problems for the tests of this room, and an independent operator in double to judge solutions.
namespace gischt::test {

template <class F>
void for_cells(const Vec3i& n, F&& f) {
    for (int k = 0; k < n.z; ++k) {
        for (int j = 0; j < n.y; ++j) {
            for (int i = 0; i < n.x; ++i) f(Vec3i(i, j, k));
        }
    }
}

// Face fractions of a solid given by a signed distance in cells, smoothed over one cell.
template <class Distance>
FaceField fractions(const TileMap::Ptr& map, Distance&& distance) {
    FaceField fraction(map, 1);
    const Vec3i n = map->bounds().size();
    for (int a = 0; a < fraction.axes(); ++a) {
        Vec3i faces = n;
        faces[a] += 1;
        for_cells(faces, [&](const Vec3i& face) {
            Vec3d p = Vec3d(face) + Vec3d(0.5);
            p[a] -= 0.5;
            fraction.ref(a, face) = static_cast<float>(std::clamp(distance(p) + 0.5, 0.0, 1.0));
        });
    }
    return fraction;
}

inline double sphere_distance(const Vec3d& p, const Vec3d& center, double radius) {
    return length(p - center) - radius;
}

// A thin board of n's proportions, turned by half a radian about z and y.
inline double board_distance(const Vec3d& p, const Vec3i& n) {
    const Vec3d c = 0.55 * Vec3d(n);
    const Vec3d q = p - c;
    const double s = std::sin(0.5), o = std::cos(0.5);
    const Vec3d turned{o * q.x + s * q.y, -s * q.x + o * q.y, q.z};
    const Vec3d again{o * turned.x + s * turned.z, turned.y, -s * turned.x + o * turned.z};
    const double w = min_component(Vec3d(n));
    const Vec3d beyond = abs(again) - Vec3d(0.2 * w, 0.25 * w, 0.05 * w);
    return max_component(beyond);
}

// What lies over one face of a cell: the open weight and the neighbour.
struct Link {
    double weight;
    Vec3i next;
    bool inside;  // false: zero beyond an open side
};
inline Link link(const TileMap& map, const Sides& sides, const FaceField* fraction, const Vec3i& c,
                 int axis, int end) {
    const int n = map.bounds().size()[axis];
    Link l{1, c, true};
    Vec3i face = c;
    face[axis] += end;
    l.next[axis] += end == 0 ? -1 : 1;
    if (l.next[axis] < 0 || l.next[axis] >= n) {
        const Side side = sides[static_cast<std::size_t>(2 * axis + end)];
        if (side == Side::Wall) return {0, c, false};
        if (side == Side::Open) l.inside = false;
        if (side == Side::Periodic) {
            l.next[axis] = (l.next[axis] + n) % n;
            face[axis] %= n;
        }
    }
    if (fraction != nullptr) l.weight = static_cast<double>(fraction->get(axis, face));
    return l;
}

// (L x)_c in double.
inline double apply(const TileField<float>& x, const Sides& sides, const FaceField* fraction,
                    const Vec3i& c) {
    double sum = 0;
    const double own = static_cast<double>(x.get(c));
    for (int a = 0; a < (x.map().is_2d() ? 2 : 3); ++a) {
        for (int end = 0; end < 2; ++end) {
            const Link l = link(x.map(), sides, fraction, c, a, end);
            const double there = l.inside ? static_cast<double>(x.get(l.next)) : 0.0;
            if (l.weight > 0) sum += l.weight * (own - there);
        }
    }
    return sum;
}

inline double residual(const TileField<float>& b, const TileField<float>& x, const Sides& sides,
                       const FaceField* fraction) {
    double worst = 0, norm = 0;
    for_cells(x.map().bounds().size(), [&](const Vec3i& c) {
        const double rhs = static_cast<double>(b.get(c));
        norm = std::max(norm, std::abs(rhs));
        worst = std::max(worst, std::abs(rhs - apply(x, sides, fraction, c)));
    });
    return worst / norm;
}

// The divergence of a jet with small structure that flows through no closed face: compatible with
// every pocket, as the right-hand side of a projection is.
inline TileField<float> plume(const TileMap::Ptr& map, const Sides& sides,
                              const FaceField* fraction) {
    TileField<float> b(map);
    const Vec3i n = map->bounds().size();
    for_cells(n, [&](const Vec3i& c) {
        double sum = 0;
        for (int a = 0; a < (map->is_2d() ? 2 : 3); ++a) {
            for (int end = 0; end < 2; ++end) {
                const Link l = link(*map, sides, fraction, c, a, end);
                Vec3i face = c;
                face[a] += end;
                if (face[a] == n[a] && l.inside) face[a] = 0;
                const Vec3d p = Vec3d(face) / Vec3d(n) - Vec3d(0.5, 0.45, 0.4);
                const double detail = std::sin(0.7 * face.x + a) * std::sin(0.9 * face.y + face.z);
                const double u = std::exp(-30 * dot(p, p)) * ((a == 1 ? 1.0 : 0.3) + detail);
                sum += (end == 0 ? -1 : 1) * l.weight * u;
            }
        }
        b.ref(c) = static_cast<float>(sum);
    });
    return b;
}

inline constexpr Sides closed_box{Side::Wall, Side::Wall, Side::Wall,
                                  Side::Wall, Side::Wall, Side::Wall};
inline constexpr Sides all_open{Side::Open, Side::Open, Side::Open,
                                Side::Open, Side::Open, Side::Open};
inline constexpr Sides all_periodic{Side::Periodic, Side::Periodic, Side::Periodic,
                                    Side::Periodic, Side::Periodic, Side::Periodic};
// Open on +y, the top of a 2-D box too.
inline constexpr Sides open_top{Side::Wall, Side::Wall, Side::Wall,
                                Side::Open, Side::Wall, Side::Wall};

}  // namespace gischt::test
