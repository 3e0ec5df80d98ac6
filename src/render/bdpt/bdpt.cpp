// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/bdpt.h"

#include <algorithm>

#include "base/error.h"
#include "render/aov.h"
#include "render/bdpt/bdpt_tracer.h"
#include "render/progressive.h"

namespace gischt {
namespace {

class BdptWorker : public PixelWorker {
  public:
    BdptWorker(const View& view, const BdptScene& scene, int depth, double margin)
        : view_(view), tracer_(scene, depth, margin) {}

    void sample(const PixelSample& at, FilmSample& out, std::span<float>) override {
        const Ray ray = view_.camera.ray(at.film_x, at.film_y, at.lens);
        const BdptTracer::Seen seen = tracer_(ray, at.lens, at.numbers);
        rays = tracer_.rays();
        lookups = tracer_.lookups();
        out.radiance = seen.radiance;
        out.alpha = seen.alpha;
        if (seen.depth >= 0) {
            out.depth = static_cast<float>(view_.camera.depth(ray, seen.depth));
        }
        splats = tracer_.splats();
    }

  private:
    const View& view_;
    BdptTracer tracer_;
};

class BdptMethod : public RenderMethod {
  public:
    explicit BdptMethod(const BdptParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        refuse_noise_of_light_paths(settings, "bdpt");
        ProgressiveTask task;
        task.method = "bdpt";
        task.layout = aov_layout(view, settings, {"bdpt"});
        task.layout.variance = false;
        task.has_light_paths = true;
        const BdptScene scene(view, params_, "bdpt", job);
        const double margin =
            ReconstructionFilter(settings.filter, static_cast<float>(settings.filter_radius))
                .radius();
        task.make_worker = [&] {
            return std::make_unique<BdptWorker>(view, scene, settings.depth, margin);
        };
        RenderResult result = render_progressively(view, settings, task, job);
        result.statistics.wall_seconds = now_seconds() - start;
        result.statistics.noise = 0;  // not known
        return result;
    }

  private:
    BdptParams params_;
};

}  // namespace

void refuse_noise_of_light_paths(const RenderSettings& settings, std::string_view method) {
    if (settings.noise > 0) {
        throw Error(ErrorKind::Usage, std::string(method),
                    "it cannot tell its noise: light paths add to all pixels",
                    "take --spp or --time, or method 'path'");
    }
    if (std::find(settings.aovs.begin(), settings.aovs.end(), "variance") != settings.aovs.end()) {
        throw Error(ErrorKind::Usage, "film.aovs",
                    "method '" + std::string(method) + "' has no 'variance'", "take method 'path'");
    }
}

std::unique_ptr<RenderMethod> make_bdpt_method(const BdptParams& params) {
    return std::make_unique<BdptMethod>(params);
}

}  // namespace gischt
