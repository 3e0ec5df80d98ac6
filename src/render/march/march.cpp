// SPDX-License-Identifier: Apache-2.0
#include "render/march/march.h"

#include <fmt/format.h>

#include "base/error.h"
#include "render/march/ray_march.h"
#include "render/progressive.h"

namespace gischt {
namespace {

constexpr Aov march_aovs[] = {Aov::Transmittance};
constexpr int most_depth = 100;
constexpr float least_opacity = 0.01f;  // below, nothing was hit

class MarchWorker : public PixelWorker {
  public:
    MarchWorker(const View& view, const MarchScene& scene, const AovLayout& layout)
        : view_(view), layout_(layout), marcher_(scene) {}

    void sample(const PixelSample& at, FilmSample& out, std::span<float> extra) override {
        const Ray ray = view_.camera.ray(at.film_x, at.film_y, at.lens, at.time);
        const MarchedRay seen = marcher_(ray, at.numbers);
        rays = marcher_.rays();
        lookups = marcher_.lookups();

        // The background shows through what is in front of it.
        const BackgroundSample behind = background(view_, ray.direction);
        out.radiance = seen.radiance + seen.transmittance * behind.radiance;
        const float through =
            (seen.transmittance.x + seen.transmittance.y + seen.transmittance.z) / 3;
        out.alpha = 1 - through * (1 - behind.alpha);
        AovLayout::add(extra, layout_.transmittance, seen.transmittance);
        if (seen.opacity > least_opacity) {
            out.depth = static_cast<float>(
                view_.camera.depth(ray, static_cast<double>(seen.depth / seen.opacity)));
        }
    }

  private:
    const View& view_;
    const AovLayout& layout_;
    RayMarcher marcher_;
};

class MarchMethod : public RenderMethod {
  public:
    explicit MarchMethod(const MarchParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        if (settings.depth < 1 || settings.depth > most_depth) {
            throw Error(ErrorKind::Usage, "march",
                        fmt::format("depth {} is not there: it goes from 1 to {}", settings.depth,
                                    most_depth),
                        "take method 'path'");
        }
        const double start = now_seconds();
        const MarchScene scene(view, params_, job, settings.depth);
        ProgressiveTask task;
        task.method = "march";
        task.layout = aov_layout(view, settings, {.method = "march", .aovs = march_aovs});
        task.make_worker = [&] { return std::make_unique<MarchWorker>(view, scene, task.layout); };
        RenderResult result = render_progressively(view, settings, task, job);
        result.statistics.wall_seconds = now_seconds() - start;
        return result;
    }

  private:
    MarchParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_march_method(const MarchParams& params) {
    return std::make_unique<MarchMethod>(params);
}

}  // namespace gischt
