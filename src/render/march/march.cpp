// SPDX-License-Identifier: Apache-2.0
#include "render/march/march.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "base/parallel.h"
#include "image/film.h"
#include "render/march/ray_march.h"

namespace gischt {
namespace {

constexpr int tile_edge = 16;  // pixels

// One picture being made.
class Marching {
  public:
    Marching(const View& view, const RenderSettings& settings, const MarchParams& params, Job& job)
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
        result.image.metadata.set("method", "march");
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
        const PhaseTimer timer(job_, "march");
        const int nx = (view_.width() + tile_edge - 1) / tile_edge,
                  ny = (view_.height() + tile_edge - 1) / tile_edge;
        std::atomic<int> tiles{0};
        parallel_ranges(nx * ny, 1, [&](int begin, int end) {
            RayMarcher marcher(scene_);
            for (int t = begin; t < end; ++t) {
                tile(marcher, t % nx, t / nx, first, count);
                const double pass_done = static_cast<double>(++tiles) / (nx * ny);
                job_.progress((first + count * pass_done) / settings_.samples_per_pixel, "march");
            }
            rays_ += marcher.rays;
            lookups_ += marcher.lookups;
        });
    }

    void tile(RayMarcher& marcher, int tile_x, int tile_y, int first, int count) {
        const int x1 = std::min((tile_x + 1) * tile_edge, view_.width()),
                  y1 = std::min((tile_y + 1) * tile_edge, view_.height());
        for (int y = tile_y * tile_edge; y < y1; ++y) {
            job_.check();
            for (int x = tile_x * tile_edge; x < x1; ++x) {
                for (int s = first; s < first + count; ++s) pixel(marcher, x, y, s);
            }
        }
    }

    void pixel(RayMarcher& marcher, int x, int y, int sample) {
        MarchSampler sampler;
        sampler.key = random_key(settings_.seed, static_cast<std::uint64_t>(view_.frame),
                                 static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
        sampler.sample = static_cast<std::uint32_t>(settings_.first_sample + sample);
        const FilterSample at = film_.sample_filter(sampler.two(0));
        const Ray ray = view_.camera.ray(x + 0.5 + static_cast<double>(at.offset.x),
                                         y + 0.5 + static_cast<double>(at.offset.y));
        const MarchedRay seen = marcher(ray, sampler);

        // The background shows through what is in front of it.
        const BackgroundSample behind = background(view_, ray.direction);
        FilmSample out;
        out.radiance = seen.radiance + seen.transmittance * behind.radiance;
        const float through =
            (seen.transmittance.x + seen.transmittance.y + seen.transmittance.z) / 3;
        out.alpha = 1 - through * (1 - behind.alpha);
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
    MarchScene scene_;
    Film film_;
    std::atomic<std::int64_t> rays_{0}, lookups_{0};
};

class MarchMethod : public RenderMethod {
  public:
    explicit MarchMethod(const MarchParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        if (settings.depth != 1) {
            throw Error(ErrorKind::Usage, "march",
                        fmt::format("depth {} is not there: it follows light once", settings.depth),
                        "take depth 1, or method 'path'");
        }
        const double start = now_seconds();
        RenderResult result = Marching(view, settings, params_, job).run();
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
