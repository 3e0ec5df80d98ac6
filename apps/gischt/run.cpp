// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.h"
#include "console.h"

namespace gischt {

int run_scene(const SceneOptions& options, CommandContext& context) {
    const Console console(context);
    const double start = now_seconds();
    ResolvedOptions r = resolve(options, context);
    const std::filesystem::path folder = work_folder(
        options, options.outputs.empty() ? std::filesystem::path("out") / r.scene.name
                                         : std::filesystem::path(options.outputs.front()));
    r.order.cache = folder;
    r.order.outputs = {(folder / (r.scene.name + ".png")).string()};
    if (r.order.frames.count() > 1)
        r.order.outputs.push_back((folder / (r.scene.name + ".mp4")).string());

    RunStatistics statistics{
        .command = context.command_line, .scene_hash = r.scene.hash, .frames = {}, .images = {}};
    const auto written = render(r.scene, r.order, statistics, context.job);
    finish_statistics(statistics, context, start);
    fmt::print("{} frames in {}, {}\n", r.order.frames.count(), folder.string(),
               duration_text(now_seconds() - start));
    if (!written.empty()) fmt::print("{}\n", written.back());
    return 0;
}

int simulate_scene(const SceneOptions& options, CommandContext& context) {
    const Console console(context);
    const double start = now_seconds();
    ResolvedOptions r = resolve(options, context);
    r.order.cache = work_folder(options, options.outputs.empty()
                                             ? std::filesystem::path("out") / r.scene.name
                                             : std::filesystem::path(options.outputs.front()));
    RunStatistics statistics{
        .command = context.command_line, .scene_hash = r.scene.hash, .frames = {}, .images = {}};
    simulate(r.scene, r.order, statistics, context.job);
    finish_statistics(statistics, context, start);
    fmt::print("{} frames in {}, {} of them computed now, {}\n", r.order.frames.count(),
               r.order.cache->string(), statistics.frames.size(),
               duration_text(now_seconds() - start));
    return 0;
}

}  // namespace gischt
