// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "console.h"
#include "scene_options.h"

namespace gischt {

static int run_scene(const SceneOptions& options, CommandContext& context) {
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

// gischt run SCENE [-o DIR]
void add_run(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<SceneOptions>();
    CLI::App* sub = app.add_subcommand("run", "Simulate, render every frame, write the movie");
    sub->add_option("SCENE", options->target, "A scene file or a built-in scene")->required();
    sub->add_option("-o,--output", options->outputs,
                    "Folder of frames, pictures and movie (default: out/NAME)")
        ->expected(1)
        ->type_name("DIR");
    add_scene_flags(*sub, *options, true);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return run_scene(*options, context); };
    });
}

static int simulate_scene(const SceneOptions& options, CommandContext& context) {
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

// gischt sim SCENE [-o CACHE]
void add_sim(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<SceneOptions>();
    CLI::App* sub =
        app.add_subcommand("sim", "Simulate only, one VDB per frame; goes on where it stopped");
    sub->add_option("SCENE", options->target, "A scene file or a built-in scene")->required();
    sub->add_option("-o,--output", options->outputs, "Folder of the frames (default: out/NAME)")
        ->expected(1)
        ->type_name("CACHE");
    add_scene_flags(*sub, *options, false);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return simulate_scene(*options, context); };
    });
}

}  // namespace gischt
