// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "console.h"
#include "scene_options.h"

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

static int render_target(const SceneOptions& options, CommandContext& context) {
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

// gischt render SCENE|FILE.vdb|CACHE [-o IMAGE]
void add_render(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<SceneOptions>();
    CLI::App* sub = app.add_subcommand(
        "render", "Render one frame or a range of a scene, a .vdb file or a cache");
    sub->add_option("TARGET", options->target,
                    "A scene, a .vdb file (or pattern name_####.vdb), or a cache folder")
        ->required();
    sub->add_option(
           "-o,--output", options->outputs,
           "Picture (.png, .exr, .hdr), state to go on with (.film), movie (.mp4) or folder; "
           "repeatable")
        ->type_name("IMAGE")
        ->allow_extra_args(false);
    sub->add_option("--turntable", options->turntable, "This many views around the object")
        ->check(CLI::Range(1, 100000));
    sub->add_option("--cache", options->cache, "Folder that keeps simulated frames")
        ->type_name("DIR");
    add_scene_flags(*sub, *options, true);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return render_target(*options, context); };
    });
}

}  // namespace gischt
