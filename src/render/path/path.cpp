// SPDX-License-Identifier: Apache-2.0
#include "render/path/path.h"

#include "render/path/path_tracer.h"
#include "render/progressive.h"

namespace gischt {
namespace {

constexpr float least_opacity = 0.01f;  // below, nothing was hit

class PathWorker : public PixelWorker {
  public:
    PathWorker(const View& view, const PathScene& scene, int depth)
        : view_(view), tracer_(scene, depth, false) {}

    void sample(const PixelSample& at, FilmSample& out, std::span<float>) override {
        const Ray ray = view_.camera.ray(at.film_x, at.film_y, at.lens, at.time);
        const TracedRay& seen = tracer_(ray, static_cast<float>(at.time), at.numbers);
        rays = tracer_.rays();
        lookups = tracer_.lookups();
        out.radiance = seen.radiance;
        out.alpha = seen.alpha;
        if (seen.opacity > least_opacity) {
            out.depth = static_cast<float>(
                view_.camera.depth(ray, static_cast<double>(seen.depth / seen.opacity)));
        }
    }

  private:
    const View& view_;
    PathTracer tracer_;
};

class PathMethod : public RenderMethod {
  public:
    explicit PathMethod(const PathParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        const PathScene scene(view, params_, job);
        ProgressiveTask task;
        task.method = "path";
        task.layout = aov_layout(view, settings, {.method = "path"});
        task.make_worker = [&] {
            return std::make_unique<PathWorker>(view, scene, settings.depth);
        };
        RenderResult result = render_progressively(view, settings, task, job);
        result.statistics.wall_seconds = now_seconds() - start;
        return result;
    }

  private:
    PathParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_path_method(const PathParams& params) {
    return std::make_unique<PathMethod>(params);
}

}  // namespace gischt
