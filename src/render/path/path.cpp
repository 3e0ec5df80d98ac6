// SPDX-License-Identifier: Apache-2.0
#include "render/path/path.h"

#include <algorithm>
#include <array>

#include "render/aov.h"
#include "render/path/path_tracer.h"
#include "render/progressive.h"

namespace gischt {
namespace {

constexpr float least_opacity = 0.01f;  // below, nothing was hit

constexpr std::array filled_aovs{Aov::Motion,        Aov::Direct,   Aov::Indirect,
                                 Aov::Emission,      Aov::Albedo,   Aov::Normal,
                                 Aov::Transmittance, Aov::Variance, Aov::Samples};

class PathWorker : public PixelWorker {
  public:
    PathWorker(const View& view, const PathScene& scene, int depth, const AovLayout& layout)
        : view_(view), layout_(layout), tracer_(scene, depth, has_groups(layout)) {
        if (layout.motion >= 0) tracer_.show_motion();
    }

    void sample(const PixelSample& at, FilmSample& out, std::span<float> extra) override {
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
        AovLayout::add(extra, layout_.direct, seen.direct);
        AovLayout::add(extra, layout_.indirect, seen.indirect);
        AovLayout::add(extra, layout_.emission, seen.emission);
        AovLayout::add(extra, layout_.albedo, seen.albedo);
        AovLayout::add(extra, layout_.normal, seen.normal);
        AovLayout::add(extra, layout_.motion, seen.motion);
        AovLayout::add(extra, layout_.transmittance, seen.transmittance);
        for (std::size_t i = 0; i < seen.of_light.size(); ++i) {
            AovLayout::add(extra, layout_.light_group[i], seen.of_light[i]);
        }
    }

  private:
    static bool has_groups(const AovLayout& layout) {
        return std::any_of(layout.light_group.begin(), layout.light_group.end(),
                           [](int place) { return place >= 0; });
    }

    const View& view_;
    const AovLayout& layout_;
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
        // Motion takes a view that knows the frames around it.
        std::span<const Aov> aovs = filled_aovs;
        if (!view.around) aovs = aovs.subspan(1);
        task.layout = aov_layout(view, settings, {"path", aovs, true});
        task.make_worker = [&] {
            return std::make_unique<PathWorker>(view, scene, settings.depth, task.layout);
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
