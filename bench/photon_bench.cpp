// SPDX-License-Identifier: Apache-2.0
// Photon mapping: a million photons in a cloud sent out, sorted into the tree, and gathered by the
// rays of a picture of 640 x 360.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "base/parallel.h"
#include "math/noise.h"
#include "optics/local_lights.h"
#include "optics/medium.h"
#include "render/photon/photon_gather.h"

namespace gischt {
namespace {

constexpr int cells = 128;

// A cloud of noise, one metre across, in the sun.
View cloud() {
    Frame frame;
    Field& field = frame.fields["density"];
    field.component.emplace_back(TileMap::box(Vec3i(cells)));
    field.to_world = Transform::scale_translate(1.0 / cells, Vec3d(-0.5));
    for (int i = 0; i < cells * cells * cells; ++i) {
        const Vec3i c(i % cells, i / cells % cells, i / cells / cells);
        const Vec3d p = field.to_world.point(Vec3d(c) + Vec3d(0.5));
        const double lump =
            0.38 - length(p) + 0.25 * static_cast<double>(fractal_noise(5.0 * p, 4, 0.5f, 3));
        if (lump > 0) field.component[0].ref(c) = static_cast<float>(std::min(1.0, 8 * lump));
    }
    MediumParams params;
    params.extinction = Keyed<Vec3d>(Vec3d(30.0));
    params.albedo = Keyed<Vec3d>(Vec3d(0.99));
    params.g = Keyed<double>(0.5);
    Job job;
    View view;
    view.media = {std::make_shared<const Medium>(frame, params, 0, job)};
    view.lights = {std::make_shared<SunLight>(normalize(Vec3d(1, -1, 2)), Vec3f(1), 0)};
    CameraParams camera;
    camera.position = Keyed<Vec3d>(Vec3d(0, -3, 0.2));
    camera.target = Keyed<Vec3d>(Vec3d());
    camera.fov_degrees = Keyed<double>(24);
    view.camera = Camera(camera, 0, 640, 360);
    return view;
}

// All that the measurements share; made once.
struct Stage {
    View view = cloud();
    Job job;
    PathParams path;
    PhotonParams params;
    std::unique_ptr<PhotonScene> scene;
    PhotonCount count;

    explicit Stage(PhotonGather gather) {
        params.gather = gather;
        scene = std::make_unique<PhotonScene>(view, params, path, 100, job);
        count = count_photons(*scene, 1, job);
    }
};

Stage& stage(PhotonGather gather) {
    static Stage beams(PhotonGather::Beams), points(PhotonGather::Points);
    return gather == PhotonGather::Beams ? beams : points;
}

void send_out(benchmark::State& state) {
    Stage& s = stage(PhotonGather::Beams);
    std::size_t kept = 0;
    for (auto _ : state) kept += trace_photons(*s.scene, s.count, 1, 0, s.job).size();
    state.SetItemsProcessed(static_cast<std::int64_t>(kept));
}
BENCHMARK(send_out)->Unit(benchmark::kMillisecond)->UseRealTime();

void sort_in(benchmark::State& state, PhotonGather gather) {
    Stage& s = stage(gather);
    const PhotonSet photons = trace_photons(*s.scene, s.count, 1, 0, s.job);
    std::size_t kept = 0;
    for (auto _ : state) kept += PhotonMap(*s.scene, photons, 0).in_media.size();
    state.SetItemsProcessed(static_cast<std::int64_t>(kept));
}
BENCHMARK_CAPTURE(sort_in, for_beams, PhotonGather::Beams)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sort_in, for_points, PhotonGather::Points)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// One ray for each pixel; direct light is not part of it.
void gather(benchmark::State& state, PhotonGather how) {
    Stage& s = stage(how);
    const auto map = std::make_unique<const PhotonMap>(
        *s.scene, trace_photons(*s.scene, s.count, 1, 0, s.job), 0);
    std::int64_t rays = 0;
    std::vector<std::int64_t> gathered(360);
    for (auto _ : state) {
        parallel_for(360, 1, [&](int y) {
            PhotonLight light(*s.scene, map);
            RayProfile profile;
            std::int64_t lookups = 0;
            for (int x = 0; x < 640; ++x) {
                const Ray ray = s.view.camera.ray(x + 0.5, y + 0.5);
                profile.trace(s.scene->path.media, ray, true, lookups);
                if (profile.is_empty()) continue;
                benchmark::DoNotOptimize(light.along(
                    ray, profile, s.scene->path.media,
                    {random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y))}));
            }
            gathered[static_cast<std::size_t>(y)] = light.gathered;
        });
        rays += 640 * 360;
    }
    double sum = 0;
    for (const std::int64_t g : gathered) sum += static_cast<double>(g);
    state.counters["photons_per_ray"] = sum / (640 * 360);
    state.SetItemsProcessed(rays);
}
BENCHMARK_CAPTURE(gather, by_beams, PhotonGather::Beams)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(gather, by_points, PhotonGather::Points)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace gischt

BENCHMARK_MAIN();
