// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/splat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "base/units.h"

namespace gischt {
namespace {

// What a cell gathers: density, momentum, heat, colour.
constexpr int channels = 8;
using Gathered = std::array<double, channels>;

// One particle on the lattice, in cells.
struct Blob {
    Vec3d center;
    double reach = 0;
    Box3i cells;       // that it may touch, inside the lattice
    double scale = 0;  // kernel to density; 0: it touches none
};

double kernel(double q2) {
    const double s = 1 - q2;
    return s > 0 ? s * s * s : 0;
}

// Calls f(cell, kernel there) for the cells of a part of a box.
template <class F>
void for_kernel(const Blob& b, const Box3i& part, F&& f) {
    for (int k = part.lo.z; k < part.hi.z; ++k) {
        for (int j = part.lo.y; j < part.hi.y; ++j) {
            for (int i = part.lo.x; i < part.hi.x; ++i) {
                const Vec3d d = Vec3d(Vec3i(i, j, k)) + Vec3d(0.5) - b.center;
                const double w = kernel(dot(d, d) / (b.reach * b.reach));
                if (w > 0) f(Vec3i(i, j, k), w);
            }
        }
    }
}

Blob blob_of(const Particles& p, std::size_t i, const SplatLattice& lattice,
             const SplatOptions& options) {
    Blob b;
    const double content = particle_content(p, i, options.density);
    b.center = (p.position[i] - lattice.origin) / lattice.h;
    b.reach = std::max(1.5, options.radius_scale * static_cast<double>(p.radius[i]) / lattice.h);
    // Far outside nothing is there, and the numbers may not fit a cell's.
    const Vec3d low = b.center - Vec3d(b.reach), high = b.center + Vec3d(b.reach);
    const bool is_near = min_component(high) > 0 && min_component(Vec3d(lattice.cells) - low) > 0;
    if (!(content > 0) || !is_near) return b;
    const Vec3d top(lattice.cells);
    b.cells = {floor(max(low, Vec3d(0))), floor(min(high, top)) + Vec3i(1)};
    b.cells = intersection(b.cells, Box3i{{}, lattice.cells});
    double sum = 0;
    for_kernel(b, b.cells, [&](const Vec3i&, double w) { sum += w; });
    if (sum > 0) b.scale = content / (sum * lattice.h * lattice.h * lattice.h);
    return b;
}

// For each tile of a sparse map the particles that touch it, in their order: those of tile t are
// [first[t], first[t + 1]) of `particle`.
struct TileLists {
    TileMap::Ptr map;
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> particle;
};

template <class F>
void for_tiles(const Blob& b, F&& f) {
    if (b.scale == 0) return;
    const Vec3i lo = tile_shape_3d.tile_of(b.cells.lo),
                hi = tile_shape_3d.tile_of(b.cells.hi - Vec3i(1));
    for (int k = lo.z; k <= hi.z; ++k) {
        for (int j = lo.y; j <= hi.y; ++j) {
            for (int i = lo.x; i <= hi.x; ++i) f(Vec3i(i, j, k));
        }
    }
}

TileLists list_by_tile(const std::vector<Blob>& blobs, const Vec3i& cells) {
    const Vec3i tiles = (cells + Vec3i(7)) / Vec3i(8);
    const auto index = [&](const Vec3i& t) {
        return static_cast<std::size_t>(t.x) +
               static_cast<std::size_t>(tiles.x) *
                   (static_cast<std::size_t>(t.y) +
                    static_cast<std::size_t>(tiles.y) * static_cast<std::size_t>(t.z));
    };
    std::vector<std::uint32_t> count(volume(tiles));
    std::vector<Vec3i> used;
    for (const Blob& b : blobs) {
        for_tiles(b, [&](const Vec3i& t) {
            if (count[index(t)]++ == 0) used.push_back(t);
        });
    }
    TileLists lists;
    lists.map = TileMap::sparse(std::move(used), {{}, cells});
    lists.first.assign(static_cast<std::size_t>(lists.map->size()) + 1, 0);
    for (int t = 0; t < lists.map->size(); ++t) {
        const auto s = static_cast<std::size_t>(t);
        lists.first[s + 1] = lists.first[s] + count[index(lists.map->coord(t))];
    }
    lists.particle.resize(lists.first.back());
    // The table now says where the next particle of a tile goes.
    std::vector<std::size_t> next(volume(tiles));
    for (int t = 0; t < lists.map->size(); ++t) {
        next[index(lists.map->coord(t))] = lists.first[static_cast<std::size_t>(t)];
    }
    for (std::size_t i = 0; i < blobs.size(); ++i) {
        for_tiles(blobs[i], [&](const Vec3i& t) {
            lists.particle[next[index(t)]++] = static_cast<std::uint32_t>(i);
        });
    }
    return lists;
}

Gathered given_by(const Particles& p, std::size_t i) {
    Gathered g{1};
    for (int a = 0; a < 3; ++a) {
        g[static_cast<std::size_t>(1 + a)] = static_cast<double>(p.velocity[i][a]);
        if (!p.color.empty())
            g[static_cast<std::size_t>(5 + a)] = static_cast<double>(p.color[i][a]);
    }
    if (!p.temperature.empty()) g[4] = static_cast<double>(p.temperature[i]);
    return g;
}

Field empty_field(const TileMap::Ptr& map, int components, const SplatLattice& lattice) {
    Field f;
    for (int c = 0; c < components; ++c) f.component.emplace_back(map);
    f.to_world = Transform::scale_translate(lattice.h, lattice.origin);
    return f;
}

}  // namespace

double particle_content(const Particles& p, std::size_t i, double density) {
    const auto r = static_cast<double>(p.radius[i]);
    const double opacity = p.opacity.empty() ? 1 : static_cast<double>(p.opacity[i]);
    return density * opacity * (4.0 / 3) * pi * r * r * r;
}

void splat_particles(const Particles& p, const SplatLattice& lattice, const SplatOptions& options,
                     Frame& frame, Job& job) {
    std::vector<Blob> blobs(p.size());
    parallel_for(static_cast<int>(p.size()), 1024, [&](int i) {
        if (job.is_cancelled()) return;
        const auto n = static_cast<std::size_t>(i);
        blobs[n] = blob_of(p, n, lattice, options);
    });
    job.check();
    const TileLists lists = list_by_tile(blobs, lattice.cells);

    Field density = empty_field(lists.map, 1, lattice),
          velocity = empty_field(lists.map, 3, lattice);
    Field temperature = empty_field(lists.map, p.temperature.empty() ? 0 : 1, lattice),
          color = empty_field(lists.map, p.color.empty() ? 0 : 3, lattice);
    parallel_for(lists.map->size(), 1, [&](int t) {
        if (job.is_cancelled()) return;
        // Sums in double, in the order of the particles.
        const auto sums = std::make_unique<std::array<Gathered, tile_values>>();
        const Box3i cells = lists.map->cells_of(t);
        const Vec3i corner = lists.map->first_cell(t);
        const auto s = static_cast<std::size_t>(t);
        for (std::size_t n = lists.first[s]; n < lists.first[s + 1]; ++n) {
            const Blob& b = blobs[lists.particle[n]];
            const Gathered g = given_by(p, lists.particle[n]);
            for_kernel(b, intersection(b.cells, cells), [&](const Vec3i& c, double w) {
                const Vec3i l = c - corner;
                Gathered& sum =
                    (*sums)[static_cast<std::size_t>(tile_shape_3d.index(l.x, l.y, l.z))];
                for (std::size_t q = 0; q < channels; ++q) sum[q] += b.scale * w * g[q];
            });
        }
        for (std::size_t i = 0; i < tile_values; ++i) {
            const Gathered& sum = (*sums)[i];
            if (sum[0] == 0) continue;
            const auto mean = [&](std::size_t q) { return static_cast<float>(sum[q] / sum[0]); };
            density.component[0].tile(t)[i] = static_cast<float>(sum[0]);
            for (std::size_t a = 0; a < 3; ++a) {
                velocity.component[a].tile(t)[i] = mean(1 + a);
                if (!color.component.empty()) color.component[a].tile(t)[i] = mean(5 + a);
            }
            if (!temperature.component.empty()) temperature.component[0].tile(t)[i] = mean(4);
        }
    });
    job.check();
    frame.fields["density"] = std::move(density);
    frame.fields["velocity"] = std::move(velocity);
    if (!temperature.component.empty()) frame.fields["temperature"] = std::move(temperature);
    if (!color.component.empty()) frame.fields["color"] = std::move(color);
}

}  // namespace gischt
