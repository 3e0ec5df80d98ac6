// SPDX-License-Identifier: Apache-2.0
// Methods on graphics hardware: seconds of the device (timer queries) per picture of 320 x 180
// pixels, the camera moving all the time; and what is done once per frame of the fluid. The label
// names the renderer: llvmpipe is the processor.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/random.h"
#include "render/billboards/billboard_drawer.h"
#include "render/march/gpu_march_drawer.h"
#include "render/points/point_drawer.h"
#include "render/realtime/test_scenes.h"
#include "render/slices/slice_drawer.h"

namespace gischt {
namespace {

const View& cloud_view(double g) {
    static const View even = test_view({test_cloud(128, test_medium(Vec3d(30.0)))});
    static const View forward = test_view({test_cloud(128, test_medium(Vec3d(30.0), 0.9, 0.5))});
    return g == 0 ? even : forward;
}

// The camera on its way around the middle.
Camera camera_at(int step, double distance = 2) {
    const double turn = 0.01 * step;
    return test_camera({distance * std::cos(turn), distance * std::sin(turn), 0.6}, 320, 180);
}

// Seconds of the device per picture of a drawer.
void draw_pictures(benchmark::State& state, SceneDrawer& drawer, const View& view,
                   double distance = 2) {
    Job job;
    GlDevice& device = offscreen_device();
    drawer.upload(view, job);
    OpaqueLayer layer(device);
    layer.upload(OpaquePainter(view, drawer.grid()).paint(camera_at(0), {}, {0.5f, 0.5f}, job));
    const GlFramebuffer target(device, {320, 180});
    drawer.draw({camera_at(0), {}, 0.5f, false}, layer, target);  // compiles
    device.finish();
    GlTimer timer(device);
    int step = 0;
    for (auto _ : state) {
        timer.begin();
        drawer.draw({camera_at(++step, distance), {}, 0.5f, false}, layer, target);
        timer.end();
        device.finish();
        state.SetIterationTime(timer.seconds());
    }
    state.SetLabel(device.limits().renderer);
    state.counters["frames_per_s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void slices(benchmark::State& state, double g, SliceSampling sampling) {
    SlicesParams params;
    params.sampling = sampling;
    SliceDrawer drawer(offscreen_device(), params);
    draw_pictures(state, drawer, cloud_view(g));
}
BENCHMARK_CAPTURE(slices, even, 0, SliceSampling::Texture)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(slices, forward, 0.5, SliceSampling::Texture)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(slices, vertices, 0, SliceSampling::Vertex)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

void gpu_march(benchmark::State& state, double g) {
    GpuMarchDrawer drawer(offscreen_device(), {});
    draw_pictures(state, drawer, cloud_view(g));
}
BENCHMARK_CAPTURE(gpu_march, even, 0)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(gpu_march, forward, 0.5)->Unit(benchmark::kMillisecond)->UseManualTime();

// 100,000 particles in a ball whose squares are 8 x 8 pixels on average.
View particle_view() {
    Frame frame;
    Particles& p = frame.particles["dust"];
    p.resize(100'000);
    p.opacity.assign(p.size(), 0.3f);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto u = [&](std::uint32_t d) {
            return static_cast<double>(random_uniform(d, static_cast<std::uint32_t>(i)));
        };
        const double z = 2 * u(1) - 1, turn = 2 * pi * u(2), r = 0.5 * std::cbrt(u(3));
        p.position[i] = r * Vec3d(std::sqrt(1 - z * z) * std::cos(turn),
                                  std::sqrt(1 - z * z) * std::sin(turn), z);
        p.radius[i] = 0.024f;  // 4 pixels at 2 m
        p.life[i] = 1;
        p.id[i] = i;
    }
    View view = test_view({});
    view.frames = {std::make_shared<const Frame>(std::move(frame))};
    return view;
}

void billboards(benchmark::State& state, ParticleOrder order, BlendPreset blend) {
    BillboardsParams params;
    params.draw.order = order;
    params.draw.blend.preset = blend;
    BillboardDrawer drawer(offscreen_device(), params);
    draw_pictures(state, drawer, particle_view());
}
BENCHMARK_CAPTURE(billboards, sorted_smoke, ParticleOrder::Sorted, BlendPreset::Smoke)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(billboards, unsorted_additive, ParticleOrder::Unsorted, BlendPreset::Additive)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

void points(benchmark::State& state) {
    PointsParams params;
    params.size = 2;
    PointDrawer drawer(offscreen_device(), params);
    draw_pictures(state, drawer, particle_view());
}
BENCHMARK(points)->Unit(benchmark::kMillisecond)->UseManualTime();

// The light of one sun or point in 128^3 cells, on the processor.
void light_grid(benchmark::State& state, bool is_sun) {
    Job job;
    const ExtinctionGrid grid =
        bake(cloud_view(0).media, cloud_view(0).media[0]->bounds(), Vec3i(128), 1, job);
    const LightOrigin origin =
        is_sun ? LightOrigin{true, normalize(Vec3d(1, -1, 2))} : LightOrigin{false, {0.6, 0.5, 1}};
    for (auto _ : state) {
        benchmark::DoNotOptimize(depths_to_centers(grid, origin, LightGridMethod::Sweep, job));
    }
}
BENCHMARK_CAPTURE(light_grid, sun, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(light_grid, point, false)->Unit(benchmark::kMillisecond)->UseRealTime();

// A new frame of the fluid: the medium on the grid, its light, all textures.
void upload(benchmark::State& state) {
    Job job;
    SliceDrawer drawer(offscreen_device(), {});
    View view = cloud_view(0);
    for (auto _ : state) {
        view.lights = {test_sun({1, -1, 2})};  // another one: nothing is kept
        drawer.upload(view, job);
        offscreen_device().finish();
    }
}
BENCHMARK(upload)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gischt

BENCHMARK_MAIN();
