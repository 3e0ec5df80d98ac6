// SPDX-License-Identifier: Apache-2.0
// The sub-commands and flags as CLI11 sees them; all of CLI11 is here.
#include "commands.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/version.h"

namespace gischt {
namespace {

void add_work_flags(CLI::App& app, CommandContext& context) {
    app.add_option("--set", context.sets, "Override a scene parameter: a.b.c=VALUE (repeatable)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    app.add_option("--threads", context.threads,
                   "Threads; 0 means all cores; results do not depend on it")
        ->check(CLI::Range(0, 4096));
    app.add_option("--simd", context.simd,
                   "Widest instruction set of the hot loops (default: what the processor has)")
        ->check(CLI::IsMember({"auto", "baseline", "avx2", "avx512"}));
    app.add_option("--progress", context.progress,
                   "bar, plain, json, none (default: bar on a terminal)")
        ->check(CLI::IsMember({"auto", "bar", "plain", "json", "none"}));
    app.add_option("--stats", context.stats_file, "Write the figures of the run to a JSON file")
        ->type_name("FILE.json");
    app.add_flag("-v,--verbose", context.verbose, "Print the time of each phase");
    app.add_flag("-q,--quiet", context.quiet, "Say nothing but errors");
}

void add_scene_flags(CLI::App& app, SceneOptions& o, bool pictures) {
    app.add_option("--frames", o.frames, "Which frames")->type_name("A-B[xSTEP]");
    app.add_option("--seed", o.seed, "Another seed gives other random numbers");
    app.add_flag("--restart", o.restart, "Throw away cached frames and films and start anew");
    app.add_flag("--resume", o.resume,
                 "Use cached frames and films and go on where they stop (the default)");
    app.add_flag(
        "--preview", o.preview,
        "Half the cells along each edge, one sample per pixel; in a folder 'preview' of its own");
    if (!pictures) return;
    app.add_option("--method", o.method, "Render method, see `gischt methods`");
    app.add_option("--size", o.size, "Size of the picture in pixels")->type_name("WxH");
    app.add_option("--spp", o.spp, "Samples per pixel");
    app.add_option("--samples", o.samples, "Range of sample indices, half-open")->type_name("A:B");
    app.add_option("--noise", o.noise, "Stop at this estimated relative noise")
        ->check(CLI::PositiveNumber);
    app.add_option("--time", o.time, "Stop after this time per picture: 90s, 10m, 2h");
    app.add_option("--preset", o.preset, "A look for any volume: smoke, fire, cloud, steam, fog");
    app.add_option("--exposure", o.exposure, "Brightness of PNG and MP4 in stops")->type_name("EV");
}

void add_probe_flag(CLI::App& app, SceneOptions& o) {
    app.add_option("--probes", o.probes,
                   "Folder of the tables of probes (default: probes in the folder of the frames)")
        ->type_name("DIR");
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
    add_probe_flag(*sub, *options);
    add_scene_flags(*sub, *options, true);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return run_scene(*options, context); };
    });
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
    add_probe_flag(*sub, *options);
    add_scene_flags(*sub, *options, false);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return simulate_scene(*options, context); };
    });
}

// gischt render SCENE|FILE.vdb|CACHE [-o IMAGE]
void add_render(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<SceneOptions>();
    CLI::App* sub = app.add_subcommand(
        "render", "Render one frame or a range of a scene, a .vdb or .ply file or a cache");
    sub->add_option("TARGET", options->target,
                    "A scene, a .vdb or .ply file (or pattern name_####.vdb), or a cache folder")
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
    add_probe_flag(*sub, *options);
    add_scene_flags(*sub, *options, true);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return render_target(*options, context); };
    });
}

// gischt flipbook SCENE|FILE.vdb|CACHE [-o STEM.png]
void add_flipbook(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<FlipbookOptions>();
    SceneOptions& o = options->scene;
    CLI::App* sub = app.add_subcommand(
        "flipbook", "Sprite sheets for games: colour, emission, depth, motion, six-way light");
    sub->add_option("TARGET", o.target, "A scene, a .vdb file or pattern, or a cache folder")
        ->required();
    sub->add_option("-o,--output", o.outputs,
                    "Stem of the sheets, STEM.png or STEM.exr; repeatable (default: NAME.png)")
        ->type_name("STEM.png")
        ->allow_extra_args(false);
    sub->add_option("--grid", options->grid,
                    "Columns and rows (default: a sheet about as wide as high)")
        ->type_name("AxB");
    sub->add_option("--cell", options->cell, "Pixels of a cell (default: 128x128)")
        ->type_name("WxH");
    sub->add_option("--loop", options->loop,
                    "Fade the last N frames over to the first ones: a loop of N cells fewer")
        ->type_name("N")
        ->check(CLI::Range(0, 100000));
    sub->add_option("--layers", options->layers,
                    "color, emission, depth, motion, light, with commas (default: all there is)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("A,B");
    sub->add_flag("--premultiplied", options->premultiplied,
                  "Values times their alpha, in place of straight alpha");
    sub->add_flag("--fit", options->fit, "Frame the fluids although the scene has a camera");
    sub->add_option("--light-scale", options->light_scale,
                    "The value of light maps that becomes 1 (default: a white wall's)");
    sub->add_option("--cache", o.cache, "Folder that keeps simulated frames (default: out/NAME)")
        ->type_name("DIR");
    sub->add_option("--frames", o.frames, "Which frames")->type_name("A-B[xSTEP]");
    sub->add_option("--seed", o.seed, "Another seed gives other random numbers");
    sub->add_flag("--restart", o.restart, "Throw away cached frames and start anew");
    sub->add_flag("--preview", o.preview,
                  "Half the cells along each edge, one sample per pixel; in a cache of its own");
    sub->add_option("--method", o.method, "Render method, see `gischt methods`");
    sub->add_option("--spp", o.spp, "Samples per pixel");
    sub->add_option("--noise", o.noise, "Stop at this estimated relative noise")
        ->check(CLI::PositiveNumber);
    sub->add_option("--time", o.time, "Stop after this time per picture: 90s, 10m, 2h");
    sub->add_option("--preset", o.preset, "A look for any volume: smoke, fire, cloud, steam, fog");
    sub->add_option("--exposure", o.exposure, "Brightness of the colour's PNG in stops")
        ->type_name("EV");
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return make_flipbook(*options, context); };
    });
}

// gischt ladder SCENE|FILE.vdb|CACHE [-o DIR]
void add_ladder(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<LadderOptions>();
    SceneOptions& o = options->scene;
    CLI::App* sub = app.add_subcommand(
        "ladder", "One scene by every method: pictures, differences, a sheet and a table");
    sub->add_option("TARGET", o.target, "A scene, a .vdb file or pattern, or a cache folder")
        ->required();
    sub->add_option("-o,--output", o.outputs, "Folder (default: out/NAME/ladder)")
        ->type_name("DIR")
        ->allow_extra_args(false);
    sub->add_option("--methods", options->methods,
                    "Only these, with commas (default: all that show light)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("A,B");
    sub->add_option("--reference", options->reference,
                    "A method, or a picture that was rendered before (default: path)")
        ->type_name("METHOD|FILE.exr");
    sub->add_option("--reference-spp", options->reference_spp,
                    "Samples per pixel of the reference (default: four times the scene's)")
        ->check(CLI::Range(1, 1 << 24));
    sub->add_option("--cache", o.cache, "Folder that keeps simulated frames")->type_name("DIR");
    add_scene_flags(*sub, o, true);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return make_ladder(*options, context); };
    });
}

// gischt check SCENE
void add_check(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<SceneOptions>();
    CLI::App* sub = app.add_subcommand(
        "check", "Validate a scene; print cells, memory, disk and time; run nothing");
    sub->add_option("SCENE", options->target, "A scene file or a built-in scene")->required();
    add_scene_flags(*sub, *options, true);
    add_work_flags(*sub, context);
    sub->callback([options, &context] {
        context.action = [options, &context] { return check_scene(*options, context); };
    });
}

// gischt view SCENE|FILE.vdb|CACHE
void add_view(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<SceneOptions>();
    CLI::App* sub = app.add_subcommand(
        "view", "The window: orbit, play, scrub, stir, switch methods, change parameters");
    sub->add_option("SCENE", options->target, "A scene, a .vdb or .ply file, or a cache folder")
        ->required();
    sub->add_option("--method", options->method,
                    "Of the moving picture: slices, gpu_march, billboards, points");
    sub->add_option("--preset", options->preset,
                    "A look for any volume: smoke, fire, cloud, steam, fog");
    sub->add_option("--cache", options->cache, "Folder of simulated frames");
    sub->add_option("--size", options->size, "Size of the window in pixels")->type_name("WxH");
    sub->add_option("--set", context.sets, "Override a scene parameter: a.b.c=VALUE (repeatable)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    sub->callback([options, &context] {
        context.action = [options, &context] { return open_window(*options, context); };
    });
}

// gischt info FILE
void add_info(CLI::App& app, CommandContext& context) {
    auto target = std::make_shared<std::string>();
    CLI::App* sub =
        app.add_subcommand("info", "What is in a .vdb, an image, a film, a cache or a scene");
    sub->add_option("FILE", *target,
                    "A .vdb, .ply, .exr, .png, .hdr or .film file, a cache folder, or a scene")
        ->required();
    sub->callback([target, &context] {
        context.action = [target, &context] { return print_info(*target, context.job); };
    });
}

// gischt merge A.film B.film ... -o OUT
void add_merge(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<MergeOptions>();
    CLI::App* sub = app.add_subcommand(
        "merge", "Add films of different samples of one picture, or develop one");
    sub->add_option("FILMS", options->films, "Films (.film) that `render --samples` wrote")
        ->required();
    sub->add_option("-o,--output", options->outputs,
                    "Film (.film) or picture (.png, .exr, .hdr); repeatable")
        ->required()
        ->type_name("FILE")
        ->allow_extra_args(false);
    sub->callback([options, &context] {
        context.action = [options, &context] { return merge_films(*options, context); };
    });
}

// gischt denoise A.exr -o B
void add_denoise(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<DenoiseOptions>();
    CLI::App* sub =
        app.add_subcommand("denoise", "Take the noise out of an .exr that has the layer variance");
    sub->add_option("A", options->from, "An .exr rendered with film.aovs=[\"variance\"]")
        ->required();
    sub->add_option("-o,--output", options->to, "Picture (.exr, .png, .hdr)")
        ->required()
        ->type_name("IMAGE");
    sub->add_option("--exposure", options->exposure, "Brightness of a .png in stops")
        ->type_name("EV");
    sub->callback([options, &context] {
        context.action = [options, &context] { return denoise_image(*options, context); };
    });
}

// gischt convert A -o B
void add_convert(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App* sub = app.add_subcommand(
        "convert", "Particles from .vdb to .ply and back; a .vdb gets their density too");
    sub->add_option("FROM", options->from, "A .vdb or .ply file, or a pattern name_####.vdb")
        ->required();
    sub->add_option("-o,--output", options->to, "A .vdb or .ply file; frames get their number")
        ->required()
        ->type_name("FILE");
    sub->add_option("--frames", options->frames, "Which frames of a pattern")
        ->type_name("A-B[xSTEP]");
    sub->add_option("--cell", options->cell_size, "Edge of the density's cells in metres")
        ->check(CLI::PositiveNumber);
    sub->add_flag("--foreign", options->foreign,
                  "Take points that other programs wrote; such files cannot be checked");
    sub->callback([options, &context] {
        context.action = [options, &context] { return convert_volume(*options, context); };
    });
}

void add_compare(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* sub = app.add_subcommand("compare", "Differences of two images; B is the reference");
    sub->add_option("A", options->a, "An image (.exr, .png, .hdr)")->required();
    sub->add_option("B", options->b, "The reference")->required();
    sub->add_option("--tol", options->tolerance, "Fail (exit status 1) when the RMSE is larger")
        ->check(CLI::NonNegativeNumber);
    sub->callback(
        [options, &context] { context.action = [options] { return compare_images(*options); }; });
}

void add_scenes(CLI::App& app, CommandContext& context) {
    auto name = std::make_shared<std::string>();
    CLI::App* sub =
        app.add_subcommand("scenes", "List the built-in scenes, or print one as a starting point");
    sub->add_option("NAME", *name, "A built-in scene");
    sub->callback([name, &context] { context.action = [name] { return print_scenes(*name); }; });
}

void add_doc(CLI::App& app, CommandContext& context) {
    auto options = std::make_shared<DocOptions>();
    CLI::App* sub = app.add_subcommand("doc", "The manual of every parameter");
    sub->add_option("COMPONENT", options->address,
                    "A component (medium), a key (medium.g) or a path (fluid.medium.g)");
    sub->add_flag("--markdown", options->markdown, "The whole manual as Markdown");
    sub->add_flag("--json-schema", options->json_schema,
                  "A JSON schema of scene files, for editors");
    sub->callback(
        [options, &context] { context.action = [options] { return print_doc(*options); }; });
}

void add_methods(CLI::App& app, CommandContext& context) {
    CLI::App* sub = app.add_subcommand(
        "methods", "The render methods: what each simulates, leaves out, and costs");
    sub->callback([&context] { context.action = [] { return print_methods(); }; });
}

// CLI11 knows the commands; the nearest one is more useful than its list.
void suggest_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
    if (std::ranges::find(names, argv[1]) != names.end()) return;
    throw Error(ErrorKind::Usage, "gischt", fmt::format("unknown command '{}'", argv[1]),
                hint_for(argv[1], names));
}

}  // namespace

std::optional<int> parse(int argc, char** argv, CommandContext& context) {
    CLI::App app("gischt simulates liquids and gases and renders them, from preview to film",
                 "gischt");
    app.set_version_flag(
        "--version",
        fmt::format("gischt {}\nOpenVDB 10, OpenEXR 3, Highway; no window, no GPU", version));
    app.require_subcommand(1);
    add_run(app, context);
    add_sim(app, context);
    add_render(app, context);
    add_flipbook(app, context);
    add_ladder(app, context);
    add_check(app, context);
    add_view(app, context);
    add_info(app, context);
    add_merge(app, context);
    add_convert(app, context);
    add_denoise(app, context);
    add_compare(app, context);
    add_scenes(app, context);
    add_doc(app, context);
    add_methods(app, context);

    suggest_command(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);  // --help, --version
    } catch (const CLI::ParseError& e) {
        throw Error(ErrorKind::Usage, "gischt", e.what(), "see gischt --help");
    }
    return std::nullopt;
}

}  // namespace gischt
