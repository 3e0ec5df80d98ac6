// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/drawer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "render/aov.h"

namespace gischt {
namespace {

constexpr float least_opacity = 0.01f;  // below, nothing was hit

double fraction(double x) {
    return x - std::floor(x);
}

// Sample i of n: points that cover the pixel evenly for any n (Roberts 2018, R2).
struct PictureSample {
    Vec2d shift;
    Vec2f disc;
    float phase = 0;
};
PictureSample sample_of(int i, int n) {
    PictureSample s;
    if (n == 1) return {{0, 0}, {0.5f, 0.5f}, 0.5f};
    s.shift = {fraction(0.5 + 0.7548776662466927 * i) - 0.5,
               fraction(0.5 + 0.5698402909980532 * i) - 0.5};
    s.disc = {static_cast<float>(fraction(0.5 + 0.5698402909980532 * i)),
              static_cast<float>(fraction(0.5 + 0.7548776662466927 * i))};
    s.phase = static_cast<float>(fraction(0.5 + 0.6180339887498949 * i));
    return s;
}

void check(std::string_view method, const RenderSettings& settings) {
    if (settings.depth != 1) {
        throw Error(ErrorKind::Usage, std::string(method),
                    fmt::format("depth {} is not there: it follows light once", settings.depth),
                    "take depth 1, or method 'path'");
    }
    if (settings.first_sample != 0 || settings.film) {
        throw Error(ErrorKind::Usage, std::string(method), "its pictures cannot be gone on with",
                    "leave out --samples and .film, or take method 'march' or 'path'");
    }
}

// Rows from top to bottom, a channel of four.
void put(std::span<float> out, const Vec2i& size, const std::vector<double>& rgba, std::size_t c,
         double scale) {
    const auto width = static_cast<std::size_t>(size.x), height = static_cast<std::size_t>(size.y);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            out[y * width + x] =
                static_cast<float>(scale * rgba[4 * ((height - 1 - y) * width + x) + c]);
        }
    }
}

void put_depth(std::span<float> out, const Vec2i& size, const std::vector<float>& sums) {
    const auto width = static_cast<std::size_t>(size.x), height = static_cast<std::size_t>(size.y);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const float* s = &sums[4 * ((height - 1 - y) * width + x)];
            out[y * width + x] =
                s[3] > least_opacity ? s[0] / s[3] : std::numeric_limits<float>::infinity();
        }
    }
}

}  // namespace

RenderResult draw_to_image(std::string_view method, SceneDrawer& drawer, const View& view,
                           const RenderSettings& settings, Job& job) {
    check(method, settings);
    (void)aov_layout(view, settings, {.method = method});
    const double start = now_seconds();
    GlDevice& device = offscreen_device();
    drawer.upload(view, job);
    const PhaseTimer timer(job, method);
    const Vec2i size{view.width(), view.height()};
    const GlFramebuffer target(device, size);
    OpaqueLayer layer(device);
    const OpaquePainter painter(view, drawer.grid());
    Image image(view.width(), view.height(),
                std::array<std::string_view, 5>{"R", "G", "B", "A", "Z"});

    std::vector<double> sum(4 * image.pixel_count());
    int done = 0;
    for (; done < settings.samples_per_pixel; ++done) {
        job.check();
        if (done > 0 && settings.time_limit > 0 && now_seconds() - start > settings.time_limit) {
            break;
        }
        const PictureSample s = sample_of(done, settings.samples_per_pixel);
        layer.upload(painter.paint(view.camera, s.shift, s.disc, job));
        DrawOrder order{view.camera, s.shift, s.phase, false};
        drawer.draw(order, layer, target);
        const std::vector<float> rgba = target.read();
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(rgba[i]);
        if (done == 0) {
            order.as_depth = true;
            drawer.draw(order, layer, target);
            put_depth(image.channel("Z"), size, target.read());
        }
        job.progress(static_cast<double>(done + 1) / settings.samples_per_pixel, method);
    }
    constexpr std::string_view names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) put(image.channel(names[c]), size, sum, c, 1.0 / done);

    RenderResult result;
    image.metadata.set("method", method);
    image.metadata.set("samples", fmt::format("{}", done));
    image.metadata.set("seed", fmt::format("{}", settings.seed));
    image.metadata.set("renderer", device.limits().renderer);
    result.image = std::move(image);
    result.statistics.samples_per_pixel = done;
    result.statistics.wall_seconds = now_seconds() - start;
    return result;
}

}  // namespace gischt
