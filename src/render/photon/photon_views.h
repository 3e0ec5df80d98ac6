// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/path/test_views.h"
#include "render/photon/photon_gather.h"

// Photon mapping for tests of means: one map per batch.
namespace gischt::photon_test {

using namespace path_test;

// A view ready to be mapped; keeps references to all.
struct Mapped {
    Job job;
    PathParams path;
    PhotonParams params;
    PhotonScene scene;
    PhotonCount count;
    std::unique_ptr<const PhotonMap> map;
    PhotonLight light;
    PathTracer tracer;

    Mapped(const View& view, const PhotonParams& the_params, int depth)
        : params(the_params),
          scene(view, params, path, depth, job),
          light(scene, map),
          tracer(scene.path, std::min(depth, 1), false) {
        path.bridge = false;
        tracer.leave_rest_to(&light);
        if (scene.has_photons) count = count_photons(scene, 99, job);
    }
    // Makes map number `pass` of a seed.
    void make(std::uint64_t seed, int pass = 0) {
        if (!scene.has_photons) return;
        map = std::make_unique<const PhotonMap>(scene, trace_photons(scene, count, seed, pass, job),
                                                pass);
    }
    Vec3d operator()(const Ray& ray, const PixelSampler& numbers) {
        return Vec3d(tracer(ray, 0.5f, numbers).radiance);
    }
};

// The mean radiance of the whole picture, `samples` rays for each of `batches` maps.
inline Estimate mapped_radiance(const View& view, const PhotonParams& params,
                                const Effort& effort) {
    Mapped mapped(view, params, effort.depth);
    return estimate(effort.batches, [&](int batch) {
        const std::uint64_t key = random_key(effort.seed, static_cast<std::uint64_t>(batch));
        mapped.make(key);
        Vec3d sum;
        for (int i = 0; i < effort.samples; ++i) {
            const PixelSampler numbers(key, 1, 0, 0, static_cast<std::uint32_t>(i));
            const Vec2f place = numbers.two(0);
            const Ray ray =
                view.camera.ray(double(place.x) * view.width(), double(place.y) * view.height());
            sum += mapped(ray, numbers);
        }
        return sum / Vec3d(effort.samples);
    });
}

}  // namespace gischt::photon_test
