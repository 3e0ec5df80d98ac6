// SPDX-License-Identifier: Apache-2.0
// Light in media: look-ups in bricks, walks, transmittance of rays, grids of light, and one frame
// of a marched cloud.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "math/noise.h"
#include "optics/environment.h"
#include "optics/light_grid.h"
#include "optics/local_lights.h"
#include "optics/medium_depth.h"
#include "render/march/march.h"
#include "render/march/march_scene.h"

namespace gischt {
namespace {

constexpr int cells = 128;

// A cloud of noise that fills about a third of its box, one metre across.
const Frame& cloud_frame() {
    static const Frame frame = [] {
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
    }();
    return frame;
}

MediumParams params() {
    MediumParams p;
    p.extinction = Keyed<Vec3d>(Vec3d(30.0));
    p.albedo = Keyed<Vec3d>(Vec3d(1.0));
    p.g = Keyed<double>(0.5);
    return p;
}

std::shared_ptr<const Medium> cloud() {
    static const auto medium = [] {
        Job job;
        return std::make_shared<const Medium>(cloud_frame(), params(), 0, job);
    }();
    return medium;
}

// Parallel rays from below, as neighbouring pixels cast them.
Ray ray(std::int64_t i) {
    const auto k = static_cast<int>(i % 16384);
    return {{(k % 128) / 128.0 - 0.5, k / 128 / 128.0 - 0.5, -1}, normalize(Vec3d(0.1, 0.2, 1))};
}

void build(benchmark::State& state) {
    Job job;
    for (auto _ : state) {
        const BrickVolume volume(cloud_frame().fields.at("density"), {}, job);
        benchmark::DoNotOptimize(volume.size());
    }
    state.SetItemsProcessed(state.iterations() * cells * cells * cells);
}
BENCHMARK(build)->Unit(benchmark::kMillisecond);

void look_up_points(benchmark::State& state) {
    const auto medium = cloud();
    std::uint32_t n = 0;
    float sum = 0;
    for (auto _ : state) {
        const float x = random_uniform(1, n++), y = random_uniform(1, n++);
        sum += medium->density(Vec3d(x - 0.5f, y - 0.5f, random_uniform(1, n++) - 0.5f));
    }
    benchmark::DoNotOptimize(sum);
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(look_up_points);

// Sixteen at a time along rays, the walk included.
void look_up_along_rays(benchmark::State& state) {
    const auto medium = cloud();
    std::int64_t rays = 0, lookups = 0;
    std::array<float, 16> t, out;
    for (auto _ : state) {
        SegmentWalk walk = medium->segments(ray(rays++), BrickGrain::Bricks);
        MediumSegment s;
        while (walk.next(s)) {
            for (std::size_t i = 0; i < t.size(); ++i) {
                t[i] = static_cast<float>((s.t1 - s.t0) * (static_cast<double>(i) + 0.5) / 16);
            }
            medium->densities(s, t, out.data());
            lookups += 16;
        }
        benchmark::DoNotOptimize(out);
    }
    state.SetItemsProcessed(lookups);
}
BENCHMARK(look_up_along_rays);

void walk(benchmark::State& state, BrickGrain grain) {
    const auto medium = cloud();
    std::int64_t rays = 0, segments = 0;
    for (auto _ : state) {
        SegmentWalk walk = medium->segments(ray(rays++), grain);
        MediumSegment s;
        while (walk.next(s)) ++segments;
    }
    state.SetItemsProcessed(segments);
}
BENCHMARK_CAPTURE(walk, blocks, BrickGrain::Blocks);
BENCHMARK_CAPTURE(walk, bricks, BrickGrain::Bricks);

// One voxel per step, over the whole ray.
void transmittance(benchmark::State& state) {
    const auto medium = cloud();
    std::int64_t rays = 0, lookups = 0;
    for (auto _ : state) {
        const float depth = density_integral(*medium, ray(rays++), {1, 1e9f}, &lookups);
        benchmark::DoNotOptimize(depth);
    }
    state.SetItemsProcessed(rays);
    state.counters["lookups"] =
        benchmark::Counter(static_cast<double>(lookups), benchmark::Counter::kIsRate);
}
BENCHMARK(transmittance);

void sun_grid(benchmark::State& state) {
    Job job;
    for (auto _ : state) {
        const SunDepth grid(*cloud(), normalize(Vec3d(1, 2, 3)), 1, job);
        benchmark::DoNotOptimize(grid.bytes());
    }
}
BENCHMARK(sun_grid)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void light_to_cells(benchmark::State& state, LightGridMethod method) {
    Job job;
    const std::vector<std::shared_ptr<const Medium>> media{cloud()};
    const ExtinctionGrid grid = bake(media, cloud()->bounds(), Vec3i(64), 2, job);
    for (auto _ : state) {
        const LightGrid light =
            light_to_cells(grid, {true, normalize(Vec3d(1, 2, 3))}, method, job);
        benchmark::DoNotOptimize(light.transmittance.data());
    }
    state.SetItemsProcessed(state.iterations() * 64 * 64 * 64);
}
BENCHMARK_CAPTURE(light_to_cells, exact, LightGridMethod::Exact)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(light_to_cells, bresenham, LightGridMethod::Bresenham)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(light_to_cells, sweep, LightGridMethod::Sweep)->Unit(benchmark::kMillisecond);

// 480 x 270 pixels, 4 samples, sun and sky, six octaves: with grids of light, and without, where
// there is only the sun.
void march_cloud(benchmark::State& state, bool light_cache) {
    MediumParams p = params();
    if (light_cache) p.multiple_scattering.octaves = 6;
    Job job;
    View view;
    view.media = {std::make_shared<const Medium>(cloud_frame(), p, 0, job)};
    view.lights = {std::make_shared<SunLight>(normalize(Vec3d(1, -2, 3)), Vec3f(3), radians(0.53))};
    if (light_cache) {
        view.lights.push_back(std::make_shared<ConstantLight>(Vec3f(0.1f, 0.2f, 0.4f)));
    }
    view.camera = Camera(fit_camera(view.media[0]->bounds(), {}), 0, 480, 270);
    MarchParams march;
    march.light_cache = light_cache;
    RenderSettings settings;
    settings.samples_per_pixel = 4;
    double lookups = 0, rays = 0;
    for (auto _ : state) {
        const RenderResult r = make_march_method(march)->render(view, settings, job);
        lookups += static_cast<double>(r.statistics.lookups);
        rays += static_cast<double>(r.statistics.rays);
    }
    state.counters["lookups"] = benchmark::Counter(lookups, benchmark::Counter::kIsRate);
    state.counters["rays"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(march_cloud, grids_of_light, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(march_cloud, second_march, false)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace gischt

BENCHMARK_MAIN();
