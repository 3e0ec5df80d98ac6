// SPDX-License-Identifier: Apache-2.0
#include "studio/statistics.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/version.h"
#include "io/atomic_file.h"

namespace gischt {

using Json = nlohmann::ordered_json;

static Json to_json(const ScalarLedger& l, double unit) {
    return {{"before", unit * l.before},       {"sources", unit * l.sources},
            {"inflow", unit * l.inflow},       {"outflow", unit * l.outflow},
            {"decayed", unit * l.decayed},     {"diffused", unit * l.diffused},
            {"numerical", unit * l.numerical}, {"after", unit * l.after}};
}

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
            {"kinetic_energy", f.figures.kinetic_energy},
            {"kinetic_energy_change", f.figures.kinetic_energy_change},
            {"mass_ledger", to_json(f.figures.density_ledger, f.figures.mass_per_volume)},
            {"heat_ledger", to_json(f.figures.heat_ledger, 1)}};
}

static Json to_json(const ImageFigures& i) {
    return {{"file", i.file},           {"frame", i.frame},
            {"method", i.method},       {"width", i.width},
            {"height", i.height},       {"samples_per_pixel", i.figures.samples_per_pixel},
            {"rays", i.figures.rays},   {"lookups", i.figures.lookups},
            {"noise", i.figures.noise}, {"wall_seconds", i.figures.wall_seconds}};
}

ScalarLedger added_up(const ScalarLedger& a, const ScalarLedger& b) {
    ScalarLedger sum = b;
    sum.before = a.before;
    sum.sources += a.sources;
    sum.inflow += a.inflow;
    sum.outflow += a.outflow;
    sum.decayed += a.decayed;
    sum.diffused += a.diffused;
    sum.numerical += a.numerical;
    return sum;
}

static std::string ledger_line(const char* what, const char* unit, const ScalarLedger& l,
                               double factor) {
    return fmt::format(
        "  {} [{}]: {:.4g} before + {:.4g} sources + {:.4g} in - {:.4g} out - {:.4g} decayed "
        "{:+.4g} diffused {:+.3g} numerical = {:.4g}\n",
        what, unit, factor * l.before, factor * l.sources, factor * l.inflow, factor * l.outflow,
        factor * l.decayed, factor * l.diffused, factor * l.numerical, factor * l.after);
}

std::string ledger_text(const RunStatistics& run) {
    std::vector<std::string> fluids;
    for (const FrameFigures& f : run.frames) {
        if (f.figures.steps > 0 && std::ranges::find(fluids, f.fluid) == fluids.end()) {
            fluids.push_back(f.fluid);
        }
    }
    std::string text;
    for (const std::string& fluid : fluids) {
        const FrameFigures *first = nullptr, *last = nullptr;
        ScalarLedger mass, heat;
        double divergence = 0, energy_change = 0;
        for (const FrameFigures& f : run.frames) {
            if (f.fluid != fluid) continue;
            mass = first ? added_up(mass, f.figures.density_ledger) : f.figures.density_ledger;
            heat = first ? added_up(heat, f.figures.heat_ledger) : f.figures.heat_ledger;
            divergence = std::max(divergence, f.figures.max_divergence_dt);
            energy_change += f.figures.kinetic_energy_change;
            if (!first) first = &f;
            last = &f;
        }
        text += fmt::format("ledger of {}, frames {} to {}:\n", fluid, first->frame, last->frame);
        text += ledger_line("smoke", "kg", mass, last->figures.mass_per_volume);
        text += ledger_line("heat", "K m^3", heat, 1);
        text +=
            fmt::format("  kinetic energy {:.4g} J, change {:+.4g} J; largest |div u| dt {:.1e}\n",
                        last->figures.kinetic_energy, energy_change, divergence);
    }
    return text;
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
