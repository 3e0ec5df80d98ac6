// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "studio/production.h"

namespace gischt {

// The flags of sub-commands that work on a scene, as typed.
struct SceneOptions {
    std::string target;  // scene file, built-in scene, .vdb file or pattern, cache folder
    std::vector<std::string> outputs;
    std::string method, preset, frames, size, samples, time, cache, probes;
    std::optional<int> spp, turntable;
    std::optional<double> exposure, noise;
    std::optional<std::int64_t> seed;
    bool preview = false, restart = false, resume = false;
};

// What the flags and the target mean.
struct ResolvedOptions {
    LoadedScene scene;
    Order order;
    bool is_bare = false;   // the target is a volume without a scene
    bool is_cache = false;  // the target is a cache folder: order.cache
};
ResolvedOptions resolve(const SceneOptions& options, CommandContext& context);

// Where frames go that would go to `folder`: a preview works beside the final frames.
std::filesystem::path work_folder(const SceneOptions& options, const std::filesystem::path& folder);

// The folder or pattern that `-o` means for pictures: "DIR" and "DIR/" become DIR/NAME.png.
std::string picture_path(const std::string& output, const std::string& name);

// Two whole numbers with a letter between them: 640x360, 0:16. Throws Error{Usage} for the flag.
std::pair<int, int> parse_pair(const std::string& text, char between, const char* flag);

// Writes --stats where it was asked for.
void finish_statistics(const RunStatistics& run, const CommandContext& context, double start);

}  // namespace gischt
