// SPDX-License-Identifier: Apache-2.0
#include "math/noise.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "math/interpolate.h"

namespace gischt {

static std::uint64_t lattice_hash(int i, int j, int k, std::uint64_t seed) {
    const auto u = [](int a) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)); };
    return mix64(seed ^ (u(i) | u(j) << 32) * 0x9e3779b97f4a7c15ULL ^ u(k) * 0xd1342543de82ef95ULL);
}

// One of the twelve edge directions of a cube, dotted with d (Perlin 2002).
static float edge_gradient(std::uint64_t hash, const Vec3f& d) {
    const auto h = static_cast<unsigned>((hash >> 32) % 12);
    const float a = h < 8 ? d.x : d.y, b = h < 4 ? d.y : d.z;
    return ((h & 1) ? -a : a) + ((h & 2) ? -b : b);
}

static float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

float gradient_noise(const Vec3d& p, std::uint64_t seed) {
    const Vec3i c = floor(p);
    const Vec3f f(p - Vec3d(c));
    const float u = fade(f.x), v = fade(f.y), w = fade(f.z);
    float corner[2][2][2];
    for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i) {
                corner[k][j][i] = edge_gradient(lattice_hash(c.x + i, c.y + j, c.z + k, seed),
                                                f - Vec3f(Vec3i(i, j, k)));
            }
        }
    }
    float plane[2];
    for (int k = 0; k < 2; ++k) {
        plane[k] = lerp(lerp(corner[k][0][0], corner[k][0][1], u),
                        lerp(corner[k][1][0], corner[k][1][1], u), v);
    }
    return lerp(plane[0], plane[1], w);
}

// One of the 32 edge directions of a hypercube, dotted with (d, w): one coordinate is left out, the
// others have signs.
static float hyperedge_gradient(std::uint64_t hash, const Vec3f& d, float w) {
    const auto h = static_cast<unsigned>(hash >> 59);
    const unsigned left_out = h >> 3;
    const float a = left_out == 0 ? w : d.x, b = left_out == 1 ? w : d.y,
                c = left_out == 2 ? w : d.z;
    return ((h & 1) ? -a : a) + ((h & 2) ? -b : b) + ((h & 4) ? -c : c);
}

float gradient_noise(const Vec3d& p, double w, std::uint64_t seed) {
    const Vec3i c = floor(p);
    const Vec3f f(p - Vec3d(c));
    const double moment = std::floor(w);
    const auto past = static_cast<float>(w - moment);
    // A lattice of its own at each whole moment, and the blend of two between.
    const auto slab = [&](int later) {
        const auto l = static_cast<std::uint64_t>(static_cast<std::int64_t>(moment) + later);
        const std::uint64_t key = mix64(seed + l * 0xd1342543de82ef95ULL);
        const float d = past - static_cast<float>(later);
        float plane[2];
        for (int k = 0; k < 2; ++k) {
            float row[2];
            for (int j = 0; j < 2; ++j) {
                const auto at = [&](int i) {
                    return hyperedge_gradient(lattice_hash(c.x + i, c.y + j, c.z + k, key),
                                              f - Vec3f(Vec3i(i, j, k)), d);
                };
                row[j] = lerp(at(0), at(1), fade(f.x));
            }
            plane[k] = lerp(row[0], row[1], fade(f.y));
        }
        return lerp(plane[0], plane[1], fade(f.z));
    };
    return past == 0 ? slab(0) : lerp(slab(0), slab(1), fade(past));
}

float fractal_noise(const Vec3d& p, int octaves, float gain, std::uint64_t seed) {
    float sum = 0, weight = 1, total = 0;
    Vec3d q = p;
    for (int o = 0; o < octaves; ++o) {
        sum += weight * gradient_noise(q, seed + static_cast<std::uint64_t>(o));
        total += weight;
        weight *= gain;
        // The odd offset keeps the zeros at lattice points of one octave off those of the next.
        q = 2.0 * q + Vec3d(0.37, 0.71, 0.53);
    }
    return total > 0 ? sum / total : 0;
}

float cellular_noise(const Vec3d& p, std::uint64_t seed) {
    const Vec3i c = floor(p);
    double nearest = 4;
    for (int k = -1; k <= 1; ++k) {
        for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i) {
                const Vec3i cell = c + Vec3i(i, j, k);
                const std::uint64_t key = lattice_hash(cell.x, cell.y, cell.z, seed);
                const Vec3d point =
                    Vec3d(cell) +
                    Vec3d(random_uniform(key, 0), random_uniform(key, 1), random_uniform(key, 2));
                const Vec3d d = point - p;
                nearest = std::min(nearest, dot(d, d));
            }
        }
    }
    return static_cast<float>(std::sqrt(nearest));
}

// An edge direction of a cube by 16 random bits, from a table: the choice cannot be foreseen.
static const Vec3d& edge_direction(std::uint64_t bits) {
    static constexpr Vec3d edges[12] = {{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0},
                                        {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                                        {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}};
    return edges[(bits & 0xffff) * 12 >> 16];
}

Vec3d curl_of_noise(const Vec3d& p, std::uint64_t seed) {
    const Vec3i c = floor(p);
    const Vec3d f = p - Vec3d(c);
    // Weights of the lower and the upper corner along each axis, and their slopes.
    double weight[3][2], slope[3][2];
    for (int a = 0; a < 3; ++a) {
        const double t = f[a], fade = t * t * t * (t * (t * 6 - 15) + 10),
                     rise = 30 * t * t * (1 - t) * (1 - t);
        weight[a][0] = 1 - fade;
        weight[a][1] = fade;
        slope[a][0] = -rise;
        slope[a][1] = rise;
    }
    Vec3d curl;
    for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i) {
                // Each corner gives the potential w N(d), N(d) = (g0.d, g1.d, g2.d), whose curl is
                // grad w x N + w curl N.
                const std::uint64_t hash = lattice_hash(c.x + i, c.y + j, c.z + k, seed);
                const Vec3d &g0 = edge_direction(hash), &g1 = edge_direction(hash >> 16),
                            &g2 = edge_direction(hash >> 32);
                const Vec3d d = f - Vec3d(Vec3i(i, j, k));
                const double x = weight[0][i], y = weight[1][j], z = weight[2][k];
                const Vec3d gradient(slope[0][i] * y * z, x * slope[1][j] * z, x * y * slope[2][k]);
                curl += cross(gradient, Vec3d(dot(g0, d), dot(g1, d), dot(g2, d))) +
                        (x * y * z) * Vec3d(g2.y - g1.z, g0.z - g2.x, g1.x - g0.y);
            }
        }
    }
    return curl;
}

// The point of one cell at a moment. An arcsine distribution at any time, as the phases are even.
static Vec3d swinging_point(const Vec3i& cell, double w, std::uint64_t seed) {
    const std::uint64_t key = lattice_hash(cell.x, cell.y, cell.z, seed);
    Vec3d point(cell);
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::uint32_t>(a);
        const double phase = static_cast<double>(random_uniform(key, axis)),
                     pace = 0.75 + 0.5 * static_cast<double>(random_uniform(key, axis + 3));
        point[a] += 0.5 + 0.5 * std::sin(2 * pi * (phase + 0.5 * pace * w));
    }
    return point;
}

CellDistances cell_distances(const Vec3d& p, double w, std::uint64_t seed) {
    const Vec3i c = floor(p);
    double first = 1e30, second = 1e30;
    // All points outside the block of cells up to `reach` away are further than `reach`.
    for (int reach = 0; second > reach * reach; ++reach) {
        const int size = 2 * reach + 1;
        for (int n = 0; n < size * size * size; ++n) {
            const Vec3i d = Vec3i(n % size, n / size % size, n / (size * size)) - Vec3i(reach);
            if (max_component(abs(d)) < reach) continue;
            // A cell that is further than the second nearest point holds none that counts.
            const Vec3d low = Vec3d(c + d) - p, gap = max(max(low, -low - Vec3d(1)), Vec3d());
            if (dot(gap, gap) >= second) continue;
            const Vec3d to = swinging_point(c + d, w, seed) - p;
            const double square = dot(to, to);
            second = std::min(second, std::max(first, square));
            first = std::min(first, square);
        }
    }
    return {static_cast<float>(std::sqrt(first)), static_cast<float>(std::sqrt(second))};
}

}  // namespace gischt
