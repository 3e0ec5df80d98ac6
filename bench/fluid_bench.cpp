// SPDX-License-Identifier: Apache-2.0
// How fast a step of smoke is: a plume that has risen for a second in a cube of air with open
// sides, everything on (MacCormack for all quantities, vorticity confinement, projection). Seconds
// per step and per phase, bytes per cell as counted below, and their share of the bandwidth that a
// triad (McCalpin 1995) reaches on the same machine and in the same run.
#include <benchmark/benchmark.h>

#include <memory>

#include "base/parallel.h"
#include "fluid/smoke.h"

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

SmokeParams plume(int resolution) {
    SmokeParams p;
    p.domain.resolution = resolution;
    p.domain.max = {2, 2, 2};
    p.domain.z_min = SideKind::FreeSlip;
    EmitterParams e;
    e.position = Vec3d(1, 1, 0.25);
    e.radius = 0.2;
    e.density = Keyed<double>(1);
    e.temperature = Keyed<double>(450);
    e.noise.amplitude = 0.8;
    p.sources = {e};
    p.vorticity_confinement = 4.0;
    return p;
}

// Bytes that a step reads and writes per cell, each field counted once per sweep, stores of fields
// that were not read counted twice. `active` is the share of blocks with smoke.
double bytes_per_cell(const SmokeSolver& solver, double iterations, double active) {
    const double predict = 3 * 4 + 3 * 8 + active * 2 * (4 + 8);
    const double correct = 6 * 4 + 3 * 8 + active * 2 * (8 + 8);
    const double forces = 3 * 4 + 3 * 8 + active * 2 * 4;
    const double divergence = 2 * (3 * 4 + 8 + 4), gradient = 4 * 4 + 3 * 4;
    return predict + correct + forces + divergence + gradient +
           iterations * solver.pressure_bytes_per_cell();
}

void smoke_step(benchmark::State& state) {
    const auto resolution = static_cast<int>(state.range(0));
    const SmokeParams params = plume(resolution);
    SmokeSolver solver(params, {});
    Job job;
    while (solver.state().time < 1) solver.step(std::min(solver.longest_step(), 1.0 / 24), job);

    const auto before = job.times();
    double iterations = 0, divergence = 0;
    const double start = now_seconds();
    for (auto _ : state) {
        const StepStatistics s = solver.step(std::min(solver.longest_step(), 1.0 / 24), job);
        iterations += s.solve.iterations;
        divergence = std::max(divergence, s.max_divergence_dt);
    }
    const auto steps = static_cast<double>(state.iterations());
    const double seconds = (now_seconds() - start) / steps;
    for (const auto& [phase, total] : job.times()) {
        const auto then = before.find(phase);
        state.counters[phase] = (total - (then == before.end() ? 0 : then->second)) / steps;
    }
    iterations /= steps;
    const auto& flags = solver.state().density.active;
    const double active =
        static_cast<double>(std::ranges::count(flags, 1)) / static_cast<double>(flags.size());
    const double cells = static_cast<double>(volume(solver.domain().cells));
    const double bytes = bytes_per_cell(solver, iterations, active);
    static const double triad = triad_bandwidth();
    state.counters["cells_per_second"] = cells / seconds;
    state.counters["iterations"] = iterations;
    state.counters["max_divergence_dt"] = divergence;
    state.counters["bytes_per_cell"] = bytes;
    state.counters["triad_GB_per_second"] = triad;
    state.counters["share_of_triad"] = bytes * cells / seconds * 1e-9 / triad;
}

BENCHMARK(smoke_step)
    ->Arg(64)
    ->Arg(128)
    ->Unit(benchmark::kSecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(8);

}  // namespace

BENCHMARK_MAIN();
