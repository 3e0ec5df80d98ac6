// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "base/error.h"
#include "scene/bare.h"
#include "scene/preset.h"
#include "scene/preview.h"

namespace gischt {
namespace fs = std::filesystem;
namespace {

// Seconds of "90", "90s", "10m", "2h".
double parse_time(const std::string& text) {
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    const std::string unit(rest, end);
    const double factor = unit.empty() || unit == "s" ? 1
                          : unit == "m"               ? 60
                          : unit == "h"               ? 3600
                                                      : 0;
    if (error != std::errc() || factor == 0 || !(number > 0)) {
        throw Error(ErrorKind::Usage, "--time", fmt::format("'{}' is no time", text),
                    "write 90s, 10m or 2h");
    }
    return number * factor;
}

bool sets_samples(const CommandContext& context) {
    return std::ranges::any_of(context.sets,
                               [](const std::string& s) { return s.starts_with("render.spp="); });
}

std::vector<std::string> overrides_of(const SceneOptions& o, const CommandContext& context) {
    std::vector<std::string> sets;
    if (o.preview) sets = {"render.spp=1"};
    sets.insert(sets.end(), context.sets.begin(), context.sets.end());
    if (!o.method.empty()) sets.push_back("render.method=" + o.method);
    // Who stops by noise or time has no number of samples in mind.
    if (!o.spp && o.samples.empty() && (o.noise || !o.time.empty()) && !sets_samples(context)) {
        sets.push_back(fmt::format("render.spp={}", 1 << 24));
    }
    if (o.spp) sets.push_back(fmt::format("render.spp={}", *o.spp));
    if (o.seed) sets.push_back(fmt::format("seed={}", *o.seed));
    if (o.exposure) sets.push_back(fmt::format("film.exposure={}", *o.exposure));
    if (!o.samples.empty()) {
        const auto [first, last] = parse_pair(o.samples, ':', "--samples");
        if (first < 0 || last <= first)
            throw Error(ErrorKind::Usage, "--samples", "A:B needs 0 <= A < B");
        sets.push_back(fmt::format("render.spp={}", last - first));
    }
    if (!o.size.empty()) {
        const auto [width, height] = parse_pair(o.size, 'x', "--size");
        sets.push_back(fmt::format("film.width={}", width));
        sets.push_back(fmt::format("film.height={}", height));
    }
    return sets;
}

bool looks_like_volume(const std::string& target) {
    const std::string extension = fs::path(target).extension().string();
    return extension == ".vdb" || extension == ".nvdb" || extension == ".ply";
}

Order order_of(const SceneOptions& o, const CommandContext& context) {
    Order order;
    order.turntable = o.turntable.value_or(0);
    order.noise = o.noise.value_or(0);
    if (!o.time.empty()) order.time_limit = parse_time(o.time);
    if (!o.samples.empty()) order.first_sample = parse_pair(o.samples, ':', "--samples").first;
    order.adaptive = o.samples.empty();
    order.preview = o.preview;
    order.restart = o.restart;
    order.command = context.command_line;
    if (!o.cache.empty()) order.cache = o.cache;
    if (!o.probes.empty()) order.probes = work_folder(o, o.probes);
    return order;
}

}  // namespace

std::pair<int, int> parse_pair(const std::string& text, char between, const char* flag) {
    int a = 0, b = 0;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, a);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == between) {
        const auto second = std::from_chars(first.ptr + 1, end, b);
        if (second.ec == std::errc() && second.ptr == end) return {a, b};
    }
    throw Error(ErrorKind::Usage, flag, fmt::format("'{}' is not of the form A{}B", text, between));
}

ResolvedOptions resolve(const SceneOptions& options, CommandContext& context) {
    ResolvedOptions r;
    const std::vector<std::string> sets = overrides_of(options, context);
    r.order = order_of(options, context);
    if (!options.frames.empty()) r.order.frames = parse_frame_range(options.frames);
    if (looks_like_volume(options.target)) {
        BareRequest request;
        request.file = options.target;
        request.preset = options.preset;
        request.frame = r.order.frames.first;
        request.overrides = sets;
        request.exposure_given = options.exposure.has_value();
        r.scene = load_bare(request, context.job);
        r.is_bare = true;
    } else if (is_cache(options.target)) {
        r.scene =
            load_scene((fs::path(options.target) / "scene.toml").string(), options.preset, sets);
        r.scene.name = cache_name(options.target);
        r.order.cache = options.target;
        r.order.keeps_scene = true;
        r.is_cache = true;
    } else {
        r.scene = load_scene(options.target, options.preset, sets);
        if (options.preview) {
            std::vector<std::string> coarse = sets;
            for (std::string& set : preview_overrides(r.scene.scene)) coarse.push_back(set);
            r.scene = load_scene(options.target, options.preset, coarse);
        }
        if (r.order.cache) r.order.cache = work_folder(options, *r.order.cache);
    }
    if (options.frames.empty())
        r.order.frames = {r.scene.scene.frames.x, r.scene.scene.frames.y, 1};
    return r;
}

fs::path work_folder(const SceneOptions& options, const fs::path& folder) {
    return options.preview ? folder / "preview" : folder;
}

std::string picture_path(const std::string& output, const std::string& name) {
    const fs::path path(output);
    return path.has_extension() ? output : (path / (name + ".png")).string();
}

void finish_statistics(const RunStatistics& run, const CommandContext& context, double start) {
    if (context.verbose > 0) {
        for (const auto& [phase, seconds] : context.job.times()) {
            std::fputs(fmt::format("{:<12} {:8.2f} s\n", phase, seconds).c_str(), stderr);
        }
        fmt::print(stderr, "{}", ledger_text(run));
    }
    if (!context.stats_file.empty()) {
        write_statistics(context.stats_file, run, context.job, now_seconds() - start);
    }
}

}  // namespace gischt
