// SPDX-License-Identifier: Apache-2.0
#include "render/path/path.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "base/parallel.h"
#include "image/film.h"
#include "render/path/path_tracer.h"

namespace gischt {
namespace {

constexpr int tile_edge = 16;  // pixels

// One picture being made.
class Tracing {
  public:
    Tracing(const View& view, const RenderSettings& settings, const PathParams& params, Job& job)
        : view_(view),
          settings_(settings),
          job_(job),
          scene_(view, params, job),
          film_(view.width(), view.height(),
                ReconstructionFilter(settings.filter, static_cast<float>(settings.filter_radius))) {
    }

    RenderResult run() {
        const double start = now_seconds();
        double last_partial = start;
        int done = 0;
        // Passes over the picture: a first one of one sample shows the whole soon.
        while (done < settings_.samples_per_pixel) {
            const int count = std::min(done == 0 ? 1 : done, settings_.samples_per_pixel - done);
            pass(done, count);
            done += count;
            const double now = now_seconds();
            if (settings_.on_partial && done < settings_.samples_per_pixel &&
                now - last_partial >= settings_.partial_interval) {
                settings_.on_partial(film_.image());
                last_partial = now_seconds();
            }
            if (settings_.noise > 0 && done > 1 && film_.noise() <= settings_.noise) break;
            if (settings_.time_limit > 0 && now - start >= settings_.time_limit) break;
        }
        RenderResult result;
        result.image = film_.image();
        result.image.metadata.set("method", "path");
        result.image.metadata.set("samples", fmt::format("{}", done));
        result.image.metadata.set("seed", fmt::format("{}", settings_.seed));
        result.statistics.samples_per_pixel = done;
        result.statistics.rays = rays_;
        result.statistics.lookups = lookups_;
        result.statistics.noise = done > 1 ? film_.noise() : 0;
        return result;
    }

  private:
    void pass(int first, int count) {
        const PhaseTimer timer(job_, "path");
        const int nx = (view_.width() + tile_edge - 1) / tile_edge,
                  ny = (view_.height() + tile_edge - 1) / tile_edge;
        std::atomic<int> tiles{0};
        parallel_ranges(nx * ny, 1, [&](int begin, int end) {
            PathTracer tracer(scene_, settings_.depth);
            for (int t = begin; t < end; ++t) {
                tile(tracer, t % nx, t / nx, first, count);
                const double pass_done = static_cast<double>(++tiles) / (nx * ny);
                job_.progress((first + count * pass_done) / settings_.samples_per_pixel, "path");
            }
            rays_ += tracer.rays();
            lookups_ += tracer.lookups();
        });
    }

    void tile(PathTracer& tracer, int tile_x, int tile_y, int first, int count) {
        const int x1 = std::min((tile_x + 1) * tile_edge, view_.width()),
                  y1 = std::min((tile_y + 1) * tile_edge, view_.height());
        for (int y = tile_y * tile_edge; y < y1; ++y) {
            job_.check();
            for (int x = tile_x * tile_edge; x < x1; ++x) {
                for (int s = first; s < first + count; ++s) pixel(tracer, x, y, s);
            }
        }
    }

    void pixel(PathTracer& tracer, int x, int y, int sample) {
        PathSampler sampler;
        sampler.key = random_key(settings_.seed, static_cast<std::uint64_t>(view_.frame),
                                 static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
        sampler.sample = static_cast<std::uint32_t>(settings_.first_sample + sample);
        const FilterSample at = film_.sample_filter(sampler.two(0));
        const Ray ray = view_.camera.ray(x + 0.5 + static_cast<double>(at.offset.x),
                                         y + 0.5 + static_cast<double>(at.offset.y));
        const TracedRay seen = tracer(ray, sampler);

        FilmSample out;
        out.radiance = seen.radiance;
        out.alpha = seen.alpha;
        if (seen.opacity > least_opacity) {
            out.depth = static_cast<float>(
                view_.camera.depth(ray, static_cast<double>(seen.depth / seen.opacity)));
        }
        out.weight = at.weight;
        film_.add(x, y, out);
    }

    static constexpr float least_opacity = 0.01f;  // below, nothing was hit

    const View& view_;
    const RenderSettings& settings_;
    Job& job_;
    PathScene scene_;
    Film film_;
    std::atomic<std::int64_t> rays_{0}, lookups_{0};
};

class PathMethod : public RenderMethod {
  public:
    explicit PathMethod(const PathParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        RenderResult result = Tracing(view, settings, params_, job).run();
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
