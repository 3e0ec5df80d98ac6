// SPDX-License-Identifier: Apache-2.0
#include "studio/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "base/error.h"
#include "io/image_file.h"

namespace gischt {
namespace {

constexpr std::string_view shows_no_light = "field";
// Methods that follow light once.
constexpr std::string_view single_scattering[] = {"points", "billboards", "slices", "gpu_march"};

// Of the whole process, all threads.
double cpu_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::string label_of(const std::string& method, int depth, bool tells_depth) {
    return tells_depth ? fmt::format("{}, depth {}", method, depth) : method;
}

RenderSettings ladder_settings(const Scene& scene, const LadderOrder& order) {
    RenderSettings s;
    s.samples_per_pixel = scene.render.spp;
    s.seed = static_cast<std::uint64_t>(scene.seed);
    s.noise = order.noise;
    s.time_limit = order.time_limit;
    s.filter = scene.film.filter;
    s.filter_radius = scene.film.filter_radius;
    s.preview = order.preview;
    s.adaptive = order.adaptive;
    return s;
}

LadderStep climb(const Scene& scene, const View& view, RenderSettings settings,
                 const LadderRung& rung, Job& job) {
    LadderStep step;
    step.rung = rung;
    settings.depth = rung.depth;
    const double wall = now_seconds(), cpu = cpu_seconds();
    try {
        RenderResult r =
            make_method(rung.method, scene.render.methods)->render(view, settings, job);
        step.image = std::move(r.image);
        step.statistics = r.statistics;
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Cancelled) throw;
        step.refusal = e.what();
    }
    step.wall_seconds = now_seconds() - wall;
    step.cpu_seconds = cpu_seconds() - cpu;
    return step;
}

// The reference, made with another seed than the steps, so that noise does not hide in common.
void add_reference(Ladder& ladder, const Scene& scene, const View& view, RenderSettings settings,
                   const LadderOrder& order, Job& job) {
    if (is_image_file(order.reference)) {
        ladder.reference = read_image(order.reference);
        ladder.reference_label = std::filesystem::path(order.reference).filename().string();
        if (ladder.reference.width == view.width() && ladder.reference.height == view.height())
            return;
        throw Error(ErrorKind::Input, order.reference,
                    fmt::format("is {}x{} pixels, the scene's film {}x{}", ladder.reference.width,
                                ladder.reference.height, view.width(), view.height()),
                    "render the reference at that size, or give --size");
    }
    settings.samples_per_pixel =
        order.reference_samples > 0 ? order.reference_samples : 4 * scene.render.spp;
    settings.seed = ~settings.seed;
    settings.time_limit = settings.noise = 0;
    settings.depth = scene.render.depth;
    RenderResult r =
        make_method(order.reference, scene.render.methods)->render(view, settings, job);
    ladder.reference = std::move(r.image);
    ladder.reference_label = fmt::format("{}, depth {}, {} samples per pixel", order.reference,
                                         settings.depth, settings.samples_per_pixel);
}

}  // namespace

std::vector<LadderRung> ladder_rungs(const std::vector<std::string>& methods, int depth) {
    std::vector<std::string> names = methods;
    for (const std::string& name : names) {
        if (find_method(name).name != shows_no_light) continue;
        throw Error(ErrorKind::Usage, "--methods", "'field' shows the data, and no light",
                    "leave it out");
    }
    if (names.empty()) {
        for (const MethodInfo& m : render_methods()) {
            if (m.name != shows_no_light) names.emplace_back(m.name);
        }
    }
    std::vector<LadderRung> rungs;
    for (const std::string& name : names) {
        std::vector<int> depths{depth};
        if (std::ranges::find(single_scattering, name) != std::end(single_scattering)) depths = {1};
        if (name == "march") {
            depths = {1, 2, 3};
            std::erase_if(depths, [depth](int d) { return d > depth; });
            if (depth > 3) depths.push_back(std::min(depth, 8));
        }
        for (const int d : depths) rungs.push_back({name, d, label_of(name, d, name == "march")});
    }
    return rungs;
}

Ladder render_ladder(const LoadedScene& scene, const LadderOrder& order, RunStatistics& run,
                     Job& job) {
    if (!is_image_file(order.reference)) find_method(order.reference);
    const auto rungs = ladder_rungs(order.methods, scene.scene.render.depth);
    const View view = frame_view(scene, order, order.frames.first, run, job);
    const RenderSettings settings = ladder_settings(scene.scene, order);
    Ladder ladder;
    const double parts = static_cast<double>(rungs.size()) + 2;
    {
        const JobPart part(job, 0, 2 / parts, "reference");
        add_reference(ladder, scene.scene, view, settings, order, job);
    }
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const double begin = (static_cast<double>(i) + 2) / parts;
        const JobPart part(job, begin, begin + 1 / parts, rungs[i].label);
        LadderStep step = climb(scene.scene, view, settings, rungs[i], job);
        if (step.refusal.empty()) step.difference = compare(step.image, ladder.reference);
        ladder.steps.push_back(std::move(step));
    }
    return ladder;
}

}  // namespace gischt
