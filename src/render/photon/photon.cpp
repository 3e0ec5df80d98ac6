// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon.h"

#include <algorithm>
#include <array>

#include "render/aov.h"
#include "render/photon/photon_gather.h"
#include "render/progressive.h"

namespace gischt {
namespace {

constexpr float least_opacity = 0.01f;  // below, nothing was hit

constexpr std::array filled_aovs{Aov::Direct, Aov::Indirect,      Aov::Emission, Aov::Albedo,
                                 Aov::Normal, Aov::Transmittance, Aov::Variance, Aov::Samples};

// Direct light, what glows and what lies behind are those of the path tracer.
PathParams direct_light_params(const PhotonParams& params) {
    PathParams path;
    path.points = params.points;
    path.splits = params.points;
    path.equiangular = params.equiangular;
    path.bridge = false;
    return path;
}

class PhotonWorker : public PixelWorker {
  public:
    PhotonWorker(const PhotonScene& scene, const std::unique_ptr<const PhotonMap>& map,
                 const AovLayout& layout)
        : view_(scene.view),
          layout_(layout),
          light_(scene, map),
          tracer_(scene.path, std::min(scene.depth, 1), false) {
        tracer_.leave_rest_to(&light_);
    }

    void sample(const PixelSample& at, FilmSample& out, std::span<float> extra) override {
        const Ray ray = view_.camera.ray(at.film_x, at.film_y, at.lens, at.time);
        const TracedRay& seen = tracer_(ray, static_cast<float>(at.time), at.numbers);
        rays = tracer_.rays();
        lookups = tracer_.lookups() + light_.gathered;
        out.radiance = seen.radiance;
        out.alpha = seen.alpha;
        if (seen.opacity > least_opacity) {
            out.depth = static_cast<float>(
                view_.camera.depth(ray, static_cast<double>(seen.depth / seen.opacity)));
        }
        AovLayout::add(extra, layout_.direct, seen.direct);
        AovLayout::add(extra, layout_.indirect, seen.indirect);
        AovLayout::add(extra, layout_.emission, seen.emission);
        AovLayout::add(extra, layout_.albedo, seen.albedo);
        AovLayout::add(extra, layout_.normal, seen.normal);
        AovLayout::add(extra, layout_.transmittance, seen.transmittance);
    }

  private:
    const View& view_;
    const AovLayout& layout_;
    PhotonLight light_;
    PathTracer tracer_;
};

class PhotonMethod : public RenderMethod {
  public:
    explicit PhotonMethod(const PhotonParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        const PathParams path_params = direct_light_params(params_);
        const PhotonScene scene(view, params_, path_params, settings.depth, job);
        const std::uint64_t seed =
            random_key(settings.seed, static_cast<std::uint64_t>(view.frame), 0x70686f746f6eULL);
        std::unique_ptr<const PhotonMap> map;
        int made = -1;
        PhotonCount count;
        ProgressiveTask task;
        task.method = "photon";
        task.layout = aov_layout(view, settings, {"photon", filled_aovs, false});
        task.group = params_.pass_samples;
        task.prepare = [&](int group) {
            const int pass = params_.passes > 0 ? std::min(group, params_.passes - 1) : group;
            if (!scene.has_photons || pass == made) return;
            map.reset();  // before the next one takes its place
            if (count.sum() == 0) count = count_photons(scene, seed, job);
            map = std::make_unique<const PhotonMap>(
                scene, trace_photons(scene, count, seed, pass, job), pass);
            made = pass;
        };
        task.make_worker = [&] { return std::make_unique<PhotonWorker>(scene, map, task.layout); };
        RenderResult result = render_progressively(view, settings, task, job);
        result.statistics.wall_seconds = now_seconds() - start;
        return result;
    }

  private:
    PhotonParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_photon_method(const PhotonParams& params) {
    return std::make_unique<PhotonMethod>(params);
}

}  // namespace gischt
