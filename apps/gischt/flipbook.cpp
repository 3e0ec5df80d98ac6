// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "commands.h"
#include "console.h"
#include "studio/flipbook.h"

namespace gischt {
namespace fs = std::filesystem;

// "DIR/" becomes DIR/NAME.png, and a stem without extension is of .png files.
static std::string sheet_path(const std::string& output, const std::string& name) {
    const fs::path path(output);
    if (!path.has_filename() || fs::is_directory(path)) return (path / (name + ".png")).string();
    return path.has_extension() ? output : output + ".png";
}

static FlipbookOrder flipbook_order(const FlipbookOptions& options, const ResolvedOptions& r) {
    FlipbookOrder order;
    static_cast<Order&>(order) = r.order;
    if (!options.grid.empty()) {
        const auto [columns, rows] = parse_pair(options.grid, 'x', "--grid");
        order.grid = Vec2i{columns, rows};
    }
    if (!options.cell.empty()) {
        const auto [width, height] = parse_pair(options.cell, 'x', "--cell");
        order.cell = {width, height};
    }
    order.loop = options.loop;
    order.layers = flipbook_layers(options.layers);
    order.emission_asked = std::ranges::find(options.layers, "emission") != options.layers.end();
    order.premultiplied = options.premultiplied;
    order.fit = options.fit;
    order.light_scale = options.light_scale;
    for (const std::string& path : options.scene.outputs)
        order.outputs.push_back(sheet_path(path, r.scene.name));
    if (order.outputs.empty()) order.outputs = {r.scene.name + ".png"};
    return order;
}

int make_flipbook(const FlipbookOptions& options, CommandContext& context) {
    const Console console(context);
    const double start = now_seconds();
    const ResolvedOptions r = resolve(options.scene, context);
    FlipbookOrder order = flipbook_order(options, r);
    // Frames are looked at more than once: they are kept where `run` and `sim` keep them.
    const bool computes = std::ranges::any_of(r.scene.scene.fluids, is_computed);
    if (computes && !order.cache)
        order.cache = work_folder(options.scene, fs::path("out") / r.scene.name);

    RunStatistics statistics{
        .command = context.command_line, .scene_hash = r.scene.hash, .frames = {}, .images = {}};
    Flipbook book = render_flipbook(r.scene, order, statistics, context.job);
    const auto written = write_flipbook(r.scene, order, std::move(book), statistics, context.job);
    finish_statistics(statistics, context, start);
    for (const std::string& path : written) fmt::print("{}\n", path);
    return 0;
}

}  // namespace gischt
