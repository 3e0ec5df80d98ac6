// SPDX-License-Identifier: Apache-2.0
#include "studio/ladder.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"
#include "commands.h"
#include "console.h"

namespace gischt {

int make_ladder(const LadderOptions& options, CommandContext& context) {
    const Console console(context);
    const double start = now_seconds();
    const ResolvedOptions r = resolve(options.scene, context);
    LadderOrder order;
    static_cast<Order&>(order) = r.order;
    // The last frame of a scene, where most has happened, unless one was asked for.
    if (options.scene.frames.empty()) order.frames.first = order.frames.last;
    order.methods = options.methods;
    order.reference = options.reference;
    order.reference_samples = options.reference_spp;
    if (options.scene.outputs.size() > 1) {
        throw Error(ErrorKind::Usage, "-o", "a ladder goes into one folder", "give one -o DIR");
    }
    order.folder = options.scene.outputs.empty()
                       ? std::filesystem::path("out") / r.scene.name / "ladder"
                       : std::filesystem::path(options.scene.outputs[0]);

    RunStatistics statistics{
        .command = context.command_line, .scene_hash = r.scene.hash, .frames = {}, .images = {}};
    const Ladder ladder = render_ladder(r.scene, order, statistics, context.job);
    const auto written = write_ladder(r.scene, order, ladder, statistics);
    finish_statistics(statistics, context, start);
    for (const std::string& path : written) fmt::print("{}\n", path);
    return 0;
}

}  // namespace gischt
