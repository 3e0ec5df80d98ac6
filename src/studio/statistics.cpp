// SPDX-License-Identifier: Apache-2.0
#include "studio/statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/version.h"
#include "io/atomic_file.h"

namespace gischt {

using Json = nlohmann::ordered_json;

static Json to_json(const FrameFigures& f) {
    return {{"frame", f.frame},
            {"fluid", f.fluid},
            {"time", f.time},
            {"steps", f.figures.steps},
            {"wall_seconds", f.figures.wall_seconds},
            {"cells", f.figures.cells},
            {"active_tiles", f.figures.active_tiles},
            {"pressure_iterations", f.figures.pressure_iterations},
            {"pressure_residual", f.figures.pressure_residual},
            {"max_divergence_dt", f.figures.max_divergence_dt},
            {"mass", f.figures.mass},
            {"volume", 0.0},
            {"kinetic_energy", f.figures.kinetic_energy}};
}

static Json to_json(const ImageFigures& i) {
    return {{"file", i.file},           {"frame", i.frame},
            {"method", i.method},       {"width", i.width},
            {"height", i.height},       {"samples_per_pixel", i.figures.samples_per_pixel},
            {"rays", i.figures.rays},   {"lookups", i.figures.lookups},
            {"noise", i.figures.noise}, {"wall_seconds", i.figures.wall_seconds}};
}

void write_statistics(const std::string& path, const RunStatistics& run, const Job& job,
                      double wall_seconds) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    Json out = {{"version", version},
                {"command", run.command},
                {"scene_hash", run.scene_hash},
                {"threads", thread_count()},
                {"wall_seconds", wall_seconds},
                {"peak_memory_bytes", usage.ru_maxrss * 1024L},  // Linux counts in KiB
                {"phases", job.times()},
                {"frames", Json::array()},
                {"images", Json::array()}};
    for (const FrameFigures& f : run.frames) out["frames"].push_back(to_json(f));
    for (const ImageFigures& i : run.images) out["images"].push_back(to_json(i));
    const std::string text = out.dump(2) + "\n";
    AtomicFile file(path);
    file.write(std::span<const char>(text));
    file.commit();
}

}  // namespace gischt
