// SPDX-License-Identifier: Apache-2.0
// What a million particles cost: a frame of four steps of a system in the air over a ground, by
// what moves them, and the splat to a density on cells of 17 mm. CPU seconds of all threads.
#include <benchmark/benchmark.h>

#include "fluid/particles/particle_source.h"
#include "fluid/particles/splat.h"

namespace {

using namespace gischt;

enum Forces { Ballistic, Drag, Eddies2, Eddies3 };

ParticleParams spray(Forces forces) {
    ParticleParams p;
    p.domain = {224, {-1.6, -1.6, 0}, {2.2, 1.6, 2.6}};
    SpoutParams ball;
    ball.kind = SpoutKind::Ball;
    ball.position = Vec3d(0.3, 0, 1.3);
    ball.radius = 1.1;
    ball.rate = {{0, 1.0 / 24}, {24e6, 0}, KeyInterpolation::Step};  // all in one frame
    ball.cone_degrees = 180;
    ball.life = 100.0;
    ball.particle_radius = 0.004;
    p.sources = {ball};
    if (forces >= Drag) p.motion.quadratic_drag = 0.06;
    if (forces >= Eddies2) {
        p.air.turbulence.speed = 0.8;
        p.air.turbulence.scale = 0.6;
        p.air.turbulence.octaves = forces == Eddies2 ? 2 : 3;
    }
    return p;
}

FluidWorld over_ground() {
    FluidWorld world;
    world.fps = 24;
    world.gravity = {0, 0, -9.81};
    SolidParams ground;
    ground.kind = SolidKind::Plane;
    ground.normal = {0, 0, 1};
    world.solids = {ground};
    return world;
}

void frame_of_a_million(benchmark::State& state) {
    const ParticleParams params = spray(static_cast<Forces>(state.range(0)));
    ParticleSystem system(params, over_ground(), {});
    Job job;
    system.step(0, 1.0 / 24, job);
    const Particles start = system.particles();
    for (auto _ : state) {
        state.PauseTiming();
        system.set_particles(start);
        state.ResumeTiming();
        for (int s = 0; s < params.substeps; ++s) {
            const double t = (4 + s) / 96.0;  // when the source gives nothing more
            system.step(t, t + 1.0 / 96, job);
        }
    }
    state.counters["particles"] = static_cast<double>(start.size());
}

void splat_of_a_million(benchmark::State& state) {
    const ParticleParams params = spray(Ballistic);
    ParticleSystem system(params, over_ground(), {});
    Job job;
    system.step(0, 1.0 / 24, job);
    const Particles particles = system.seen();
    for (auto _ : state) {
        Frame frame;
        splat_particles(particles, splat_lattice(params.domain), {}, frame, job);
        benchmark::DoNotOptimize(frame.fields.size());
    }
    state.counters["particles"] = static_cast<double>(particles.size());
}

BENCHMARK(frame_of_a_million)
    ->ArgName("forces")
    ->DenseRange(Ballistic, Eddies3)
    ->Unit(benchmark::kSecond)
    ->MeasureProcessCPUTime();
BENCHMARK(splat_of_a_million)->Unit(benchmark::kSecond)->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();
