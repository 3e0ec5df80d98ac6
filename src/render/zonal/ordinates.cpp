// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/ordinates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "math/quadrature.h"
#include "math/sobol.h"
#include "render/zonal/zone_sweep.h"

namespace gischt {

OrdinateSet::OrdinateSet(int polar, int azimuth) : cosines_(2 * polar), angles_(4 * azimuth) {
    // Each half of the cosines has nodes of its own, since light is cut at the horizon (Sykes
    // 1951).
    const GaussLegendre rule(polar);
    const auto n = static_cast<std::size_t>(polar);
    for (int c = 0; c < cosines_; ++c) {
        const auto k = static_cast<std::size_t>(c) % n;
        const bool is_upper = c >= polar;
        const double node = 0.5 * (rule.node[is_upper ? k : n - 1 - k] + 1);
        const double z = is_upper ? node : -node;
        const double r = std::sqrt(1 - z * z);
        for (int a = 0; a < angles_; ++a) {
            const double angle = 2 * pi * (a + 0.5) / angles_;
            direction.push_back({r * std::cos(angle), r * std::sin(angle), z});
            weight.push_back(0.5 * rule.weight[is_upper ? k : n - 1 - k] * 2 * pi / angles_);
        }
    }
}

std::size_t OrdinateSet::flipped(std::size_t i, std::uint8_t flips) const {
    int c = static_cast<int>(i) / angles_, a = static_cast<int>(i) % angles_;
    if (flips & 1) a = (angles_ / 2 - 1 - a + angles_) % angles_;
    if (flips & 2) a = angles_ - 1 - a;
    if (flips & 4) c = cosines_ - 1 - c;
    return static_cast<std::size_t>(c * angles_ + a);
}

std::vector<float> scattering_kernel(const OrdinateSet& set, const PhaseFunction& phase) {
    const std::size_t n = set.size();
    std::vector<double> k(n * n), scale(n, 1.0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            k[i * n + j] = static_cast<double>(
                value(phase, static_cast<float>(dot(set.direction[i], set.direction[j]))));
        }
    }
    // k_ij becomes d_i k_ij d_j with sums of 1.
    for (int iteration = 0; iteration < 200; ++iteration) {
        for (std::size_t j = 0; j < n; ++j) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) sum += set.weight[i] * scale[i] * k[i * n + j];
            scale[j] = std::sqrt(scale[j] / sum);
        }
    }
    std::vector<float> kernel(n * n);
    double cosine = 0;
    for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += set.weight[i] * scale[i] * k[i * n + j];
        for (std::size_t i = 0; i < n; ++i) {
            const double v = scale[i] * k[i * n + j] / sum;
            kernel[i * n + j] = static_cast<float>(v);
            cosine += set.weight[i] * set.weight[j] / (4 * pi) * v *
                      dot(set.direction[i], set.direction[j]);
        }
    }
    const double truth = mean_cosine(phase);
    if (std::abs(cosine - truth) > 0.02) {
        throw Error(ErrorKind::Usage, "zonal",
                    fmt::format("{} ordinates see a phase function of mean cosine {:.3g} as {:.3g}",
                                n, truth, cosine),
                    "raise render.zonal.ordinates, or take solver = \"auto\" or method 'path'");
    }
    return kernel;
}

std::int64_t ordinate_bytes(std::size_t zones, std::size_t ordinates) {
    return static_cast<std::int64_t>(zones * ordinates * 4 * sizeof(Vec3f));
}

namespace {

constexpr int starts_per_cell = 4;

// What a sweep along one ordinate and its mirror images leaves behind.
struct OrdinateSweep {
    const Enclosure& enclosure;
    const OrdinateSet& set;
    const std::vector<Vec3f>& source;        // by zone and ordinate
    const std::vector<Vec3f>& patch_source;  // of patches
    std::vector<Vec3f>& at;                  // sums of radiance times length, by the same
    std::vector<float>& length;              // sums of length
    std::vector<Vec3f>& patches;             // W of each, then what radiance 1 would be
    std::vector<Vec3f>& leaving;             // W

    // Lines along ordinate m through all sides that it enters by. Only its mirror images are
    // written besides, so that ordinates whose images differ may run at once.
    void run(std::size_t m) const {
        LineTracer tracer(enclosure);
        const Vec3d& d = set.direction[m];
        const ZoneGrid& grid = enclosure.grid;
        const Vec3d h = grid.cell_size();
        for (int side = 0; side < 6; ++side) {
            const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
            if (enclosure.sides[static_cast<std::size_t>(side)] == EnclosureSide::Mirror) continue;
            if ((d[axis] > 0) != (side % 2 == 0)) continue;
            const double area = h[u] * h[v] * std::abs(d[axis]) / starts_per_cell;
            const std::size_t first = enclosure.first_side_cell(side);
            const int cells = grid.cells[u] * grid.cells[v];
            for (int cell = 0; cell < cells; ++cell) {
                for (int i = 0; i < starts_per_cell; ++i) {
                    const Vec2f place =
                        sobol_2d(static_cast<std::uint32_t>(i), 5 + static_cast<std::uint32_t>(m));
                    Vec3d from;
                    from[axis] = side % 2 == 0 ? grid.box.lo[axis] : grid.box.hi[axis];
                    from[u] = grid.box.lo[u] +
                              h[u] * (cell % grid.cells[u] + static_cast<double>(place.x));
                    from[v] = grid.box.lo[v] +
                              h[v] * (cell / grid.cells[u] + static_cast<double>(place.y));
                    tracer.trace(from, d, static_cast<int>(first) + cell);
                    follow(tracer, m, side, area);
                }
            }
        }
    }

    void follow(const LineTracer& line, std::size_t m, int side, double area) const {
        const ZoneGrid& grid = enclosure.grid;
        const auto power = static_cast<float>(area * set.weight[m]);
        for (const LinePiece& p : line.pieces) {
            Vec3f light = p.from_patch >= 0  ? patch_source[static_cast<std::size_t>(p.from_patch)]
                          : p.from_cell >= 0 ? enclosure.incoming[static_cast<std::size_t>(side)]
                                             : Vec3f{};
            for (std::size_t i = p.first; i < p.last; ++i) {
                const ZoneCrossing& c = line.crossings[i];
                const std::size_t at_zone =
                    c.zone * set.size() + (c.flips ? set.flipped(m, c.flips) : m);
                const Vec3f& e = grid.extinction[c.zone];
                const Vec3f& q = source[at_zone];
                ChordLength chord = chord_length(e.x, c.length);
                const auto share = static_cast<float>(area);
                for (int k = 0; k < 3; ++k) {
                    if (k > 0 && !grid.is_grey) chord = chord_length(e[k], c.length);
                    at[at_zone][k] += share * (light[k] * chord.l + q[k] * chord.m);
                    light[k] = light[k] - light[k] * e[k] * chord.l + q[k] * chord.l;
                }
                length[at_zone] += share * c.length;
            }
            if (p.to_patch >= 0) {
                const auto patch = static_cast<std::size_t>(p.to_patch);
                patches[patch] += power * light;
                patches[enclosure.patches.size() + patch].x += power;
            } else if (p.to_cell >= 0) {
                leaving[static_cast<std::size_t>(p.to_cell)] += power * light;
            }
        }
    }
};

// Ordinates fall into orbits under mirrors; each orbit is one task.
std::vector<std::vector<std::size_t>> orbits_of(const OrdinateSet& set) {
    std::vector<std::vector<std::size_t>> orbits;
    std::vector<bool> seen(set.size(), false);
    for (std::size_t m = 0; m < set.size(); ++m) {
        if (seen[m]) continue;
        orbits.emplace_back();
        for (int flips = 0; flips < 8; ++flips) {
            const std::size_t image = set.flipped(m, static_cast<std::uint8_t>(flips));
            if (seen[image]) continue;
            seen[image] = true;
            orbits.back().push_back(image);
        }
    }
    return orbits;
}

}  // namespace

OrdinateSolution solve_ordinates(const Enclosure& enclosure, const OrdinateSet& set,
                                 const std::vector<float>& kernel, const std::vector<Vec3f>& source,
                                 const std::vector<Vec3f>& patch_source,
                                 const OrdinateLimits& limits, Job& job) {
    const std::size_t zones = enclosure.grid.size(), n = set.size(),
                      patches = enclosure.patches.size();
    const auto orbits = orbits_of(set);
    OrdinateSolution solution;
    solution.radiance.resize(zones * n);
    solution.patches.resize(patches);
    std::vector<Vec3f> q = source, patch_q = patch_source, at(zones * n);
    std::vector<float> length(zones * n);
    float before = -1;
    for (;; ++solution.iterations) {
        std::fill(at.begin(), at.end(), Vec3f{});
        std::fill(length.begin(), length.end(), 0.0f);
        std::vector<std::vector<Vec3f>> orbit_patches(orbits.size()), orbit_leaving(orbits.size());
        parallel_for(static_cast<int>(orbits.size()), 1, [&](int o) {
            job.check();
            const auto i = static_cast<std::size_t>(o);
            orbit_patches[i].resize(2 * patches);
            orbit_leaving[i].resize(enclosure.side_cells());
            const OrdinateSweep sweep{
                enclosure, set, q, patch_q, at, length, orbit_patches[i], orbit_leaving[i]};
            for (const std::size_t m : orbits[i]) sweep.run(m);
        });
        solution.leaving.assign(enclosure.side_cells(), Vec3f{});
        std::vector<Vec3f> on_patches(2 * patches);
        for (std::size_t o = 0; o < orbits.size(); ++o) {
            for (std::size_t i = 0; i < 2 * patches; ++i) on_patches[i] += orbit_patches[o][i];
            for (std::size_t i = 0; i < solution.leaving.size(); ++i) {
                solution.leaving[i] += orbit_leaving[o][i];
            }
        }
        for (std::size_t i = 0; i < patches; ++i) {
            // pi times the area that the lines of all ordinates see.
            const float measure = on_patches[patches + i].x;
            solution.patches[i] = measure > 0 ? on_patches[i] / Vec3f(measure) : Vec3f{};
            patch_q[i] = patch_source[i] + enclosure.patches[i].albedo * solution.patches[i];
        }
        // What arrives is scattered anew.
        std::vector<float> change(zones), most(zones);
        parallel_for(static_cast<int>(zones), 16, [&](int zone) {
            const auto z = static_cast<std::size_t>(zone);
            std::vector<Vec3f> light(n);
            for (std::size_t m = 0; m < n; ++m) {
                const std::size_t i = z * n + m;
                light[m] = length[i] > 0 ? at[i] / Vec3f(length[i]) : Vec3f{};
                change[z] =
                    std::max(change[z], max_component(abs(light[m] - solution.radiance[i])));
                most[z] = std::max(most[z], max_component(light[m]));
                solution.radiance[i] = light[m];
            }
            for (std::size_t m = 0; m < n; ++m) light[m] *= static_cast<float>(set.weight[m]);
            for (std::size_t m = 0; m < n; ++m) {
                Vec3f sum;
                const float* row = kernel.data() + m * n;
                for (std::size_t k = 0; k < n; ++k) sum += row[k] * light[k];
                q[z * n + m] = source[z * n + m] + enclosure.grid.scattering[z] * sum;
            }
        });
        const float changed = *std::max_element(change.begin(), change.end()),
                    largest = *std::max_element(most.begin(), most.end());
        if (!(largest > 0)) return solution;
        // The rest of a geometric series: change * ratio / (1 - ratio).
        const float ratio = before > 0 ? std::min(changed / before, 0.999f) : 0.5f;
        before = changed;
        const double rest = static_cast<double>(changed / largest * ratio / (1 - ratio));
        if (solution.iterations > 0 && rest <= limits.tolerance) return solution;
        if (solution.iterations >= limits.most_iterations) {
            throw Error(ErrorKind::Usage, "zonal",
                        fmt::format("ordinates still change by {:.1e} after {} iterations",
                                    static_cast<double>(changed / largest), solution.iterations),
                        "thick media take long: raise render.zonal.iterations, or take "
                        "solver = \"auto\"");
        }
    }
}

}  // namespace gischt
