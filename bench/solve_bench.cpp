// SPDX-License-Identifier: Apache-2.0
// How fast the Poisson solver is: time and iterations of a solution, bytes per cell and iteration
// as counted in solve/kernels.h, and their share of the bandwidth that a triad (McCalpin 1995)
// reaches on the same machine and in the same run.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/parallel.h"
#include "solve/diffusion.h"

namespace {

using namespace gischt;

// GB/s of a = b + s c over 3 x 64 MB, all threads, 16 bytes per value with the read of a that a
// store causes; the best of eight.
double triad_bandwidth() {
    constexpr int blocks = 4096, block = 4096;
    AlignedVector<float> a(std::size_t{blocks} * block), b(a.size(), 1.0f), c(a.size(), 2.0f);
    double best = 0;
    for (int repeat = 0; repeat < 8; ++repeat) {
        const double start = now_seconds();
        parallel_for(blocks, 64, [&](int n) {
            const std::size_t first = static_cast<std::size_t>(n) * block;
            for (std::size_t i = first; i < first + block; ++i) a[i] = b[i] + 0.5f * c[i];
        });
        best = std::max(best, 16e-9 * static_cast<double>(a.size()) / (now_seconds() - start));
        benchmark::DoNotOptimize(a.data());
    }
    return best;
}

// Divergence of a plume: a smooth jet with small structure, as after one step of a smoke.
TileField<float> plume(const TileMap::Ptr& map) {
    const Vec3i n = map->bounds().size();
    const auto velocity = [&](int axis, const Vec3i& face) {
        if (face[axis] == 0 || face[axis] == n[axis]) return 0.0;
        double r2 = 0;
        for (int a = 0; a < 3; ++a) {
            const double d = (face[a] + 0.5) / n[a] - (a == 2 ? 0.35 : 0.5);
            r2 += d * d;
        }
        const double detail = std::sin(0.7 * face.x + axis) * std::sin(0.5 * face.y + 0.9 * face.z);
        return std::exp(-40 * r2) * ((axis == 2 ? 1.0 : 0.0) + 0.3 * detail);
    };
    TileField<float> b(map);
    for (int k = 0; k < n.z; ++k) {
        for (int j = 0; j < n.y; ++j) {
            for (int i = 0; i < n.x; ++i) {
                double divergence = 0;
                for (int a = 0; a < 3; ++a) {
                    Vec3i upper{i, j, k};
                    upper[a] += 1;
                    divergence += velocity(a, upper) - velocity(a, {i, j, k});
                }
                b.ref({i, j, k}) = static_cast<float>(divergence);
            }
        }
    }
    return b;
}

// Face fractions around a sphere, smoothed over a cell.
FaceField around_sphere(const TileMap::Ptr& map) {
    const Vec3i n = map->bounds().size();
    FaceField fraction(map, 1);
    for (int a = 0; a < 3; ++a) {
        for (int k = 0; k <= n.z; ++k) {
            for (int j = 0; j <= n.y; ++j) {
                for (int i = 0; i <= n.x; ++i) {
                    const Vec3i face{i, j, k};
                    bool exists = true;
                    for (int o = 0; o < 3; ++o) exists = exists && (o == a || face[o] < n[o]);
                    if (!exists) continue;
                    const Vec3d p = Vec3d(face) + Vec3d(0.5) - 0.5 * Vec3d(a == 0, a == 1, a == 2);
                    const double distance = length(p - 0.5 * Vec3d(n)) - 0.15 * n.x;
                    fraction.ref(a, face) =
                        static_cast<float>(std::clamp(distance + 0.5, 0.0, 1.0));
                }
            }
        }
    }
    return fraction;
}

// Arguments: cells per axis, with a sphere, exponent of the tolerance, threads.
void solve_plume(benchmark::State& state) {
    static const double bandwidth = triad_bandwidth();
    const ThreadLimit limit(static_cast<int>(state.range(3)));
    const auto map = TileMap::box(Vec3i(static_cast<int>(state.range(0))));
    const Sides sides{Side::Wall, Side::Wall, Side::Wall, Side::Wall, Side::Wall, Side::Open};
    const FaceField fraction = state.range(1) != 0 ? around_sphere(map) : FaceField();
    PoissonSolver solver(map, sides, state.range(1) != 0 ? &fraction : nullptr);
    const TileField<float> b = plume(map);
    TileField<float> x(map);
    Job job;
    SolveResult result;
    double best = 1e9;
    for (auto _ : state) {
        std::ranges::fill(x.values(), 0.0f);
        const double start = now_seconds();
        result = solver.solve(b, x, std::pow(10.0, -static_cast<double>(state.range(2))), 50, job);
        best = std::min(best, now_seconds() - start);
    }
    const double cells = static_cast<double>(volume(map->bounds().size()));
    const double updates = cells * result.iterations / best;
    const double rate = updates * solver.bytes_per_cell_iteration() * 1e-9;
    state.counters["best_ms"] = 1e3 * best;
    state.counters["iterations"] = result.iterations;
    state.counters["iterations/s"] = result.iterations / best;
    state.counters["Mcells/s"] = 1e-6 * updates;
    state.counters["bytes/cell"] = solver.bytes_per_cell_iteration();
    state.counters["GB/s"] = rate;
    state.counters["triad_GB/s"] = bandwidth;
    state.counters["share"] = rate / bandwidth;
}
BENCHMARK(solve_plume)
    ->ArgNames({"cells", "sphere", "tolerance", "threads"})
    ->Args({64, 0, 6, 0})
    ->Args({128, 0, 6, 0})
    ->Args({128, 0, 6, 1})
    ->Args({128, 1, 6, 0})
    ->Args({128, 0, 4, 0})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// Setting up levels and coefficients, as after every step of a moving solid.
void set_up(benchmark::State& state) {
    const auto map = TileMap::box(Vec3i(static_cast<int>(state.range(0))));
    const Sides sides{Side::Wall, Side::Wall, Side::Wall, Side::Wall, Side::Wall, Side::Open};
    const FaceField fraction = around_sphere(map);
    for (auto _ : state) {
        PoissonSolver solver(map, sides, state.range(1) != 0 ? &fraction : nullptr);
        benchmark::DoNotOptimize(solver.bytes_per_cell_iteration());
    }
}
BENCHMARK(set_up)
    ->ArgNames({"cells", "sphere"})
    ->Args({128, 0})
    ->Args({128, 1})
    ->Unit(benchmark::kMillisecond);

// One implicit step of a scalar; arguments: cells per axis, 100 times the diffusion number.
void diffuse_scalar(benchmark::State& state) {
    const auto map = TileMap::box(Vec3i(static_cast<int>(state.range(0))));
    const TileField<float> start = plume(map);
    TileField<float> x(map);
    Job job;
    SolveResult result;
    for (auto _ : state) {
        x.values() = start.values();
        result = diffuse(x, 0.01 * static_cast<double>(state.range(1)),
                         {Borders::all(Border::Even), {}}, nullptr, {}, job);
    }
    state.counters["iterations"] = result.iterations;
}
BENCHMARK(diffuse_scalar)
    ->ArgNames({"cells", "percent"})
    ->Args({128, 10})
    ->Args({128, 10000})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
