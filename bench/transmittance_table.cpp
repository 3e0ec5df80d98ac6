// SPDX-License-Identifier: Apache-2.0
// Estimators of the transmittance of a ray side by side: variance times density look-ups, that of
// ratio tracking against majorants of 8^3 voxels being 1. Less is better.
//
//     transmittance_table [--cloud FILE.vdb] [--smoke FILE.vdb] ...
//
// Rays pass random points of the volume in random directions; the extinction is such that half of
// them have an optical depth above 2. Without files a ball of noise is taken.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/vdb.h"
#include "math/noise.h"
#include "optics/medium.h"
#include "render/path/tracking.h"

namespace gischt {
namespace {

constexpr int rays = 400, estimates = 200;

Frame noise_frame() {
    constexpr int cells = 128;
    Frame f;
    Field& field = f.fields["density"];
    field.component.emplace_back(TileMap::box(Vec3i(cells)));
    field.to_world = Transform::scale_translate(1.0 / cells, Vec3d(-0.5));
    for (int i = 0; i < cells * cells * cells; ++i) {
        const Vec3i c(i % cells, i / cells % cells, i / cells / cells);
        const Vec3d p = field.to_world.point(Vec3d(c) + Vec3d(0.5));
        const double lump =
            0.38 - length(p) + 0.25 * static_cast<double>(fractal_noise(5.0 * p, 4, 0.5f, 3));
        if (lump > 0) field.component[0].ref(c) = static_cast<float>(std::min(1.0, 8 * lump));
    }
    return f;
}

// Bounds and mean of the density in cubes of so many voxels.
struct Cubes {
    int edge;
    std::map<std::array<int, 3>, BrickVolume::Block> known;

    Cubes(const BrickVolume& v, int size) : edge(size) {
        for (int b = 0; b < v.size(); ++b) {
            for (int i = 0; i < BrickVolume::brick_blocks; ++i) {
                const Vec3i first = v.coord(b) * 8 + 4 * Vec3i(i & 1, i >> 1 & 1, i >> 2);
                const auto cube = [this](int x) { return x >= 0 ? x / edge : (x + 1) / edge - 1; };
                const auto [at, is_new] =
                    known.try_emplace({cube(first.x), cube(first.y), cube(first.z)});
                BrickVolume::Block& c = at->second;
                const BrickVolume::Block& block = v.block(b, i);
                c.min = is_new ? block.min : std::min(c.min, block.min);
                c.max = std::max(c.max, block.max);
                const double share = std::pow(4.0 / edge, 3);
                c.mean += static_cast<float>(share) * block.mean;
            }
        }
        // A cube of which a part is not stored has a minimum of 0.
        if (edge > 4) {
            for (auto& [at, c] : known) c.min = 0;
        }
    }
    BrickVolume::Block at(const Vec3d& q) const {
        const Vec3i c = floor(q / Vec3d(edge));
        const auto found = known.find({c.x, c.y, c.z});
        return found == known.end() ? BrickVolume::Block{} : found->second;
    }
};

// A stretch of a ray in one cube, densities times the extinction, 1/m.
struct Stretch {
    double t0, t1;
    float min, mean, max;
};

std::vector<Stretch> stretches(const Medium& medium, const Cubes& cubes, const Ray& ray) {
    const BrickVolume& v = *medium.bricks();
    const Vec3d origin = v.to_lattice().point(ray.origin),
                step = v.to_lattice().vector(ray.direction);
    const Interval inside =
        clip({origin, step, 0, 1e30}, {Vec3d(v.support().lo), Vec3d(v.support().hi)});
    if (inside.is_empty()) return {};
    std::vector<double> cut{inside.t0, inside.t1};
    for (int a = 0; a < 3; ++a) {
        if (step[a] == 0) continue;
        const double from = origin[a] + inside.t0 * step[a], to = origin[a] + inside.t1 * step[a];
        for (double k = std::ceil(std::min(from, to) / cubes.edge);
             k * cubes.edge < std::max(from, to); ++k) {
            cut.push_back((k * cubes.edge - origin[a]) / step[a]);
        }
    }
    std::sort(cut.begin(), cut.end());
    std::vector<Stretch> out;
    for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
        const BrickVolume::Block b = cubes.at(origin + 0.5 * (cut[i] + cut[i + 1]) * step);
        const float s = medium.strength();
        if (b.max > 0) out.push_back({cut[i], cut[i + 1], s * b.min, s * b.mean, s * b.max});
    }
    return out;
}

struct Trial {
    const Medium& medium;
    RandomStream random;
    std::int64_t lookups = 0;

    float extinction(const Ray& ray, double t) {
        ++lookups;
        return medium.strength() * medium.density(ray.at(t));
    }
};

enum class Control { None, Minimum, Mean };

// Ratio tracking, with a control.
double ratio(Trial& trial, const std::vector<Stretch>& way, const Ray& ray, Control kind) {
    double product = 1;
    for (const Stretch& s : way) {
        const float control = kind == Control::None ? 0 : kind == Control::Minimum ? s.min : s.mean;
        const float majorant = std::max(s.max - control, control - s.min);
        product *= std::exp(-static_cast<double>(control) * (s.t1 - s.t0));
        if (!(majorant > 1e-6f * s.max)) continue;
        double t = s.t0;
        while (true) {
            t -= std::log(1 - static_cast<double>(trial.random.next())) /
                 static_cast<double>(majorant);
            if (t >= s.t1) break;
            product *= 1 - static_cast<double>((trial.extinction(ray, t) - control) / majorant);
        }
    }
    return product;
}

// Delta tracking: whether a flight passes.
double delta(Trial& trial, const Ray& ray, double t0, double t1) {
    const auto majorant = static_cast<double>(trial.medium.majorant());
    for (double t = t0;;) {
        t -= std::log(1 - static_cast<double>(trial.random.next())) / majorant;
        if (t >= t1) return 1;
        const auto here = static_cast<double>(trial.extinction(ray, t));
        if (static_cast<double>(trial.random.next()) * majorant < here) return 0;
    }
}

using Estimator = std::function<double(Trial&, const Ray&, int ray_number)>;

struct Row {
    double variance = 0, lookups = 0, bias = 0;
};

Row measure(const Medium& medium, const std::vector<Ray>& ways, const Estimator& estimator) {
    Row row;
    double spread = 0;
    for (int r = 0; r < rays; ++r) {
        const Ray& ray = ways[static_cast<std::size_t>(r)];
        std::int64_t none = 0;
        const double truth = std::exp(-static_cast<double>(medium.strength()) *
                                      exact_density_integral(medium, ray, none));
        double sum = 0, squares = 0;
        Trial trial{medium, RandomStream{random_key(3, static_cast<std::uint64_t>(r))}, 0};
        for (int i = 0; i < estimates; ++i) {
            const double off = estimator(trial, ray, r) - truth;
            sum += off / estimates;
            squares += off * off / estimates;
        }
        row.variance += squares / rays;
        row.lookups += static_cast<double>(trial.lookups) / estimates / rays;
        row.bias += sum / rays;
        spread += squares / estimates / rays / rays;
    }
    // In standard errors; what is exact but for rounding has none.
    row.bias = row.variance > 1e-12 ? row.bias / std::sqrt(spread) : 0;
    return row;
}

void table(const std::string& name, const Frame& frame) {
    Job job;
    MediumParams params;
    params.extinction = Keyed<Vec3d>(Vec3d(1));
    params.albedo = Keyed<Vec3d>(Vec3d());
    const Medium one(frame, params, 0, job);
    const Box3d box = one.bounds();
    std::vector<Ray> ways;
    std::vector<double> depths;
    for (std::uint64_t i = 0; depths.size() < rays; ++i) {
        RandomStream random{random_key(1, i)};
        const auto u = [&] { return static_cast<double>(random.next()); };
        const Vec3d through = box.lo + Vec3d(u(), u(), u()) * box.size();
        const double z = 2 * u() - 1, turn = 6.283185307179586 * u(), s = std::sqrt(1 - z * z);
        const Vec3d d(s * std::cos(turn), s * std::sin(turn), z);
        const Ray ray{through - 2 * length(box.size()) * d, d};
        std::int64_t none = 0;
        const double depth = exact_density_integral(one, ray, none);
        if (!(depth > 0) && i < 1'000'000) continue;
        ways.push_back(ray);
        depths.push_back(depth);
    }
    std::nth_element(depths.begin(), depths.begin() + rays / 2, depths.end());
    params.extinction = Keyed<Vec3d>(Vec3d(2 / depths[rays / 2]));
    const Medium medium(frame, params, 0, job);

    const Medium* media[] = {&medium};
    std::map<int, std::vector<std::vector<Stretch>>> by_edge;
    for (const int edge : {4, 8, 16}) {
        const Cubes cubes(*medium.bricks(), edge);
        for (const Ray& ray : ways) by_edge[edge].push_back(stretches(medium, cubes, ray));
    }
    const auto tracked = [&](int edge, Control control) -> Estimator {
        return [&by_edge, edge, control](Trial& trial, const Ray& ray, int r) {
            return ratio(trial, by_edge[edge][static_cast<std::size_t>(r)], ray, control);
        };
    };
    MarchEstimate march;
    const auto marched = [&](float steps) -> Estimator {
        return [&, steps](Trial& trial, const Ray& ray, int) {
            return static_cast<double>(
                march.transmittance(media, ray, steps, trial.random, trial.lookups).x);
        };
    };
    Tracker tracker;
    tracker.media = media;
    const auto built_in = [&](TransmittanceEstimator kind) -> Estimator {
        return [&, kind](Trial& trial, const Ray& ray, int) {
            tracker.lookups = 0;
            const double t = static_cast<double>(tracker.transmittance(ray, kind, trial.random).x);
            trial.lookups += tracker.lookups;
            return t;
        };
    };
    const Estimator unbounded = [&](Trial& trial, const Ray& ray, int r) {
        const auto& way = by_edge[16][static_cast<std::size_t>(r)];
        return way.empty() ? 1 : delta(trial, ray, way.front().t0, way.back().t1);
    };
    const std::pair<std::string, Estimator> rows[] = {
        {"delta tracking, one majorant", unbounded},
        {"ratio tracking, 16^3", tracked(16, Control::None)},
        {"ratio tracking, 8^3", tracked(8, Control::None)},
        {"ratio tracking, 4^3", tracked(4, Control::None)},
        {"residual ratio, minimum, 4^3", tracked(4, Control::Minimum)},
        {"residual ratio, mean, 8^3", tracked(8, Control::Mean)},
        {"residual ratio, mean, 4^3", tracked(4, Control::Mean)},
        {"gischt: ratio", built_in(TransmittanceEstimator::Ratio)},
        {"gischt: residual_ratio", built_in(TransmittanceEstimator::ResidualRatio)},
        {"debiased march, 0.5 steps", marched(0.5f)},
        {"debiased march, 1 step", marched(1)},
        {"debiased march, 2 steps", marched(2)},
        {"gischt: march", built_in(TransmittanceEstimator::March)},
        {"gischt: exact", built_in(TransmittanceEstimator::Exact)},
    };
    const Row unit = measure(medium, ways, tracked(8, Control::None));
    fmt::print("{}\n  {:38} {:>10} {:>9} {:>9} {:>6}\n", name, "", "variance", "look-ups",
               "product", "z");
    for (const auto& [label, estimator] : rows) {
        const Row row = measure(medium, ways, estimator);
        fmt::print("  {:38} {:10.2e} {:9.1f} {:9.4f} {:6.1f}\n", label, row.variance, row.lookups,
                   row.variance * row.lookups / (unit.variance * unit.lookups), row.bias);
    }
}

}  // namespace
}  // namespace gischt

int main(int count, char** arguments) {
    using namespace gischt;
    bool any = false;
    try {
        for (int i = 1; i + 1 < count; ++i) {
            const std::string name = arguments[i];
            if (name != "--cloud" && name != "--smoke") continue;
            Job job;
            table(name.substr(2), read_vdb(arguments[i + 1], {}, job));
            any = true;
        }
        if (!any) table("noise", noise_frame());
    } catch (const Error& e) {
        fmt::print(stderr, "{}\n", e.what());
        return 1;
    }
    return 0;
}
