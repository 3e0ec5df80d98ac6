// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "studio/estimate.h"

namespace gischt {

static std::string bytes_text(double bytes) {
    return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes * 1e-6)
                       : fmt::format("{:.1f} GB", bytes * 1e-9);
}

int check_scene(const SceneOptions& options, CommandContext& context) {
    const ResolvedOptions r = resolve(options, context);
    const Scene& scene = r.scene.scene;
    const int frames = r.order.frames.count();
    fmt::print("{}: {}\n", r.scene.name, scene.description);
    double seconds = 0, disk = 0, memory = 0;
    for (const FluidEstimate& e : estimate_fluids(scene)) {
        fmt::print("  fluid {:<10} {}", e.name, e.source);
        if (e.cells.x > 0)
            fmt::print(", {} x {} x {} cells of {:.4g} m", e.cells.x, e.cells.y, e.cells.z,
                       e.cell_size);
        fmt::print("\n");
        seconds += e.seconds_per_frame * frames;
        disk += e.disk_per_frame * frames;
        memory += e.memory;
    }
    const double pictures = estimate_picture_seconds(scene) * frames;
    fmt::print("  {} frames, pictures {} x {} by {}\n", frames, scene.film.width, scene.film.height,
               scene.render.method);
    fmt::print("  memory about {}, disk about {}\n", bytes_text(memory + 1e8), bytes_text(disk));
    fmt::print("  time about {} to simulate and {} to render on 2 cores\n", duration_text(seconds),
               duration_text(pictures));
    fmt::print("good\n");
    return 0;
}

}  // namespace gischt
