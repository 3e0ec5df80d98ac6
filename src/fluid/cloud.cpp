// SPDX-License-Identifier: Apache-2.0
#include "fluid/cloud.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/units.h"
#include "math/interpolate.h"
#include "math/noise.h"

namespace gischt {

const Table<CloudParams>& cloud_table() {
    using P = CloudParams;
    static const Table<P> table =
        Table<P>("cloud", "A cumulus made of noise on a heap of spheres")
            .add("resolution", &P::resolution,
                 {.help = "Cells along the longest edge", .min = 8, .max = 2048})
            .add("min", &P::min,
                 {.unit = "m", .help = "Lower corner of the box that the cloud fills"})
            .add("max", &P::max, {.unit = "m", .help = "Upper corner"})
            .add("towers", &P::towers, {.help = "Large spheres on the base", .min = 1, .max = 200})
            .add("generations", &P::generations,
                 {.help = "How often smaller spheres grow on the last ones", .min = 0, .max = 5})
            .add("lumpiness", &P::lumpiness,
                 {.help = "Height of the billows as a share of their size", .min = 0, .max = 2})
            .add("octaves", &P::octaves,
                 {.help = "Octaves of billows, each half as large", .min = 1, .max = 10})
            .add("edge", &P::edge,
                 {.help = "Share of the box's height over which the density rises to 1",
                  .min = 0,
                  .max = 1,
                  .min_open = true})
            .add("flatness", &P::flatness,
                 {.help = "Share of the box's height in which the base evaporates",
                  .min = 0,
                  .max = 1,
                  .min_open = true})
            .add("evolution", &P::evolution,
                 {.unit = "m/s", .help = "Speed at which the billows rise through the cloud"})
            .add("seed", &P::seed, {.help = "Another seed makes another cloud", .min = 0})
            .check([](const P& p, const Fail& fail) {
                if (min_component(p.max - p.min) <= 0)
                    fail("max", "must be above 'min' in every component");
            });
    return table;
}

namespace {

struct Puff {
    Vec3d center;
    double radius;
};

// The axes of a cloud's own frame: two horizontal, one up; all are unit axes, so that the box stays
// a box.
struct Axes {
    int right, forward, up;
    double sign;  // of `up`

    explicit Axes(const Vec3d& direction) {
        up = std::abs(direction.x) > 0.5 ? 0 : std::abs(direction.y) > 0.5 ? 1 : 2;
        right = (up + 1) % 3;
        forward = (up + 2) % 3;
        sign = direction[up] < 0 ? -1 : 1;
    }
};

// Grows the heap: towers on an ellipse of the base, high in the middle, then ever smaller puffs on
// the upper half of each.
std::vector<Puff> grow_puffs(const CloudParams& p, const Axes& axes) {
    const Vec3d size = p.max - p.min, middle = 0.5 * (p.min + p.max);
    const double height = size[axes.up], base = axes.sign > 0 ? p.min[axes.up] : p.max[axes.up];
    const auto seed = static_cast<std::uint64_t>(p.seed);
    auto at = [&](double x, double y, double z) {
        Vec3d q;
        q[axes.right] = x;
        q[axes.forward] = y;
        q[axes.up] = z;
        return q;
    };
    std::vector<Puff> puffs;
    for (int i = 0; i < p.towers; ++i) {
        const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(i));
        // Sunflower spiral: even over the disc, so that no seed leaves a gap.
        const double r = std::sqrt((i + 0.3 * random_uniform(key, 0)) / p.towers);
        const double phi = 2.399963 * i + 6.28 * random_uniform(random_key(seed), 1);
        const double radius = height * (0.33 - 0.17 * r) * (0.85 + 0.3 * random_uniform(key, 2));
        const double x = 0.31 * size[axes.right] * r * std::cos(phi),
                     y = 0.31 * size[axes.forward] * r * std::sin(phi);
        const double z =
            base + axes.sign * (0.75 * radius + height * 0.2 * (1 - r) * random_uniform(key, 3));
        puffs.push_back({at(middle[axes.right] + x, middle[axes.forward] + y, z), radius});
    }
    std::size_t first = 0;
    for (int g = 0; g < p.generations; ++g) {
        const std::size_t last = puffs.size();
        for (std::size_t i = first; i < last; ++i) {
            const Puff parent = puffs[i];
            for (std::uint64_t child = 0; child < 5; ++child) {
                const std::uint64_t key = random_key(seed, 1000 + i, child);
                const double z = axes.sign * (1.1 * random_uniform(key, 0) - 0.1),
                             phi = 2 * pi * random_uniform(key, 1);
                const double s = std::sqrt(std::max(0.0, 1 - z * z));
                const double radius = parent.radius * (0.42 + 0.2 * random_uniform(key, 2));
                puffs.push_back({parent.center + parent.radius * 0.85 *
                                                     at(s * std::cos(phi), s * std::sin(phi), z),
                                 radius});
            }
        }
        first = last;
    }
    return puffs;
}

// Sum of octaves of |noise|, in [0, ~0.6]: round bumps with sharp creases between them.
double billows(const Vec3d& p, int octaves, std::uint64_t seed) {
    double sum = 0, weight = 1;
    Vec3d q = p;
    for (int o = 0; o < octaves; ++o, weight *= 0.5) {
        sum +=
            weight *
            std::abs(static_cast<double>(gradient_noise(q, seed + static_cast<std::uint64_t>(o))));
        q = 2.0 * q + Vec3d(0.37, 0.71, 0.53);
    }
    return sum;
}

struct Shaper {
    const CloudParams& p;
    Axes axes;
    std::vector<Puff> puffs;
    double h, height, lump, reach, time;

    // Distance to the heap, over the puffs that matter in a tile.
    static double distance(const std::vector<Puff>& near, const Vec3d& x) {
        double d = 1e30;
        for (const Puff& s : near) d = std::min(d, length(x - s.center) - s.radius);
        return d;
    }
    std::vector<Puff> near_tile(const Vec3d& center, double radius) const {
        double nearest = 1e30;
        for (const Puff& s : puffs)
            nearest = std::min(nearest, length(center - s.center) - s.radius);
        std::vector<Puff> near;
        if (nearest > radius + reach) return near;
        for (const Puff& s : puffs) {
            if (length(center - s.center) - s.radius <= nearest + 2 * radius) near.push_back(s);
        }
        return near;
    }
    float density(const std::vector<Puff>& near, const Vec3d& x) const {
        const double above =
            axes.sign * (x[axes.up] - (axes.sign > 0 ? p.min[axes.up] : p.max[axes.up]));
        const double base = smoothstep(above / (p.flatness * height));
        double d = distance(near, x);
        if (d > reach || base <= 0) return 0;
        // Deep inside nothing but the base shows; near the surface the billows push outwards.
        if (d > -p.edge * height - reach) {
            Vec3d q = x;
            q[axes.up] -= axes.sign * p.evolution * time;
            d -= lump *
                 (billows(q / (lump / p.lumpiness), p.octaves, static_cast<std::uint64_t>(p.seed)) -
                  0.15);
        }
        return static_cast<float>(base * smoothstep(-d / (p.edge * height)));
    }
};

}  // namespace

Frame make_cloud(const CloudParams& params, const Vec3d& up, double time, Job& job) {
    const Vec3d size = params.max - params.min;
    if (min_component(size) <= 0)
        throw Error(ErrorKind::Usage, "cloud", "the box from 'min' to 'max' is empty");
    const double h = max_component(size) / params.resolution;
    const Axes axes(up);
    const double height = size[axes.up], wavelength = 0.22 * height;
    const double lump = std::max(1e-9, params.lumpiness) * wavelength;
    const Shaper shaper{params, axes, grow_puffs(params, axes), h, height, lump, 0.7 * lump, time};

    // Tiles that the heap touches.
    const Vec3i cells = max(floor(size / h + Vec3d(0.5)), Vec3i(2));
    const TileMap::Ptr box = TileMap::box(cells);
    const double tile_radius = 0.5 * std::sqrt(3.0) * 8 * h;
    std::vector<Vec3i> tiles;
    auto center_of = [&](const Vec3i& tile) {
        return params.min + (Vec3d(tile) * 8.0 + Vec3d(4)) * h;
    };
    for (int t = 0; t < box->size(); ++t) {
        if (!shaper.near_tile(center_of(box->coord(t)), tile_radius).empty())
            tiles.push_back(box->coord(t));
    }

    Frame frame;
    frame.time = time;
    Field& field = frame.fields["density"];
    field.component.emplace_back(TileMap::sparse(std::move(tiles), {{}, cells}));
    field.to_world = Transform::scale_translate(h, params.min);
    TileField<float>& density = field.component[0];
    const TileMap& map = density.map();
    parallel_for(map.size(), 1, [&](int t) {
        if (job.is_cancelled()) return;
        const auto puffs = shaper.near_tile(center_of(map.coord(t)), tile_radius);
        const Vec3i first = map.first_cell(t);
        for (int i = 0; i < tile_values; ++i) {
            const Vec3i c = first + map.shape().cell(i);
            density.tile(t)[i] =
                map.bounds().contains(c)
                    ? shaper.density(puffs, params.min + (Vec3d(c) + Vec3d(0.5)) * h)
                    : 0;
        }
    });
    job.check();
    return frame;
}

}  // namespace gischt
