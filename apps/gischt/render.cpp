// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/error.h"
#include "commands.h"
#include "console.h"

namespace gischt {

// One picture unless a movie or a range was asked for: the last frame of a scene, where most has
// happened.
static void choose_frames(const SceneOptions& options, ResolvedOptions& r, Job& job) {
    bool movie = false;
    for (const std::string& path : r.order.outputs) movie = movie || path.ends_with(".mp4");
    if (!options.frames.empty() || movie || r.order.frames.count() == 1) return;
    r.order.frames.first = r.order.frames.last;
    job.info(fmt::format("rendering frame {}; --frames chooses others", r.order.frames.last));
}

int render_target(const SceneOptions& options, CommandContext& context) {
    const Console console(context);
    const double start = now_seconds();
    ResolvedOptions r = resolve(options, context);
    if (options.outputs.empty()) r.order.outputs = {r.scene.name + ".png"};
    for (const std::string& path : options.outputs)
        r.order.outputs.push_back(picture_path(path, r.scene.name));
    choose_frames(options, r, context.job);

    RunStatistics statistics{
        .command = context.command_line, .scene_hash = r.scene.hash, .frames = {}, .images = {}};
    const auto written = render(r.scene, r.order, statistics, context.job);
    finish_statistics(statistics, context, start);
    for (const std::string& path : written) fmt::print("{}\n", path);
    return 0;
}

}  // namespace gischt
