// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/mlt.h"

#include <algorithm>
#include <cmath>

#include "render/aov.h"
#include "render/bdpt/bdpt.h"
#include "render/mlt/mlt_chain.h"
#include "render/progressive.h"

namespace gischt {
namespace {

BdptParams bdpt_params_of(const MltParams& params) {
    BdptParams p;
    p.shadow = params.shadow;
    p.connection = 0;
    return p;
}

// What the chains leave out: what the camera sees itself, also by mirrors and through glass, and
// what is scattered once before it.
class PlainWorker : public PixelWorker {
  public:
    PlainWorker(const View& view, const BdptScene& scene, int depth, bool direct)
        : view_(view), direct_(direct && depth > 0), tracer_(scene, direct_ ? 1 : 0, 0) {}

    void sample(const PixelSample& at, FilmSample& out, std::span<float>) override {
        const Ray ray = view_.camera.ray(at.film_x, at.film_y, at.lens);
        const BdptTracer::Seen seen = tracer_.near(ray, direct_, at.numbers);
        rays = tracer_.rays();
        lookups = tracer_.lookups();
        out.radiance = seen.radiance;
        out.alpha = seen.alpha;
        if (seen.depth >= 0) {
            out.depth = static_cast<float>(view_.camera.depth(ray, seen.depth));
        }
    }

  private:
    const View& view_;
    bool direct_;
    BdptTracer tracer_;
};

class MltMethod : public RenderMethod {
  public:
    explicit MltMethod(const MltParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        refuse_noise_of_light_paths(settings, "mlt");
        const double margin =
            ReconstructionFilter(settings.filter, static_cast<float>(settings.filter_radius))
                .radius();
        const BdptScene scene(view, bdpt_params_of(params_), "mlt", job);
        const MltPathsMaker make = [&] {
            return std::make_unique<MltPaths>(scene, params_, settings.depth, margin);
        };
        MltRound round;
        round.mutations = static_cast<std::int64_t>(view.width()) * view.height();
        round.chains = static_cast<int>(std::min<std::int64_t>(params_.chains, round.mutations));
        round.pool = std::max<std::int64_t>(
            64, std::llround(params_.bootstrap * static_cast<double>(round.mutations)));
        ProgressiveTask task;
        task.method = "mlt";
        task.layout = aov_layout(view, settings, {"mlt"});
        task.layout.variance = false;
        task.make_worker = [&] {
            return std::make_unique<PlainWorker>(view, scene, settings.depth, params_.direct);
        };
        task.painted_paths = round.mutations;
        task.paint = [&](std::uint32_t index) {
            const std::uint64_t key = random_key(
                settings.seed, static_cast<std::uint64_t>(view.frame), std::uint64_t{index});
            return paint_round(round, params_, key, make, job);
        };
        RenderResult result = render_progressively(view, settings, task, job);
        result.statistics.wall_seconds = now_seconds() - start;
        result.statistics.noise = 0;  // not known
        return result;
    }

  private:
    MltParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_mlt_method(const MltParams& params) {
    return std::make_unique<MltMethod>(params);
}

}  // namespace gischt
