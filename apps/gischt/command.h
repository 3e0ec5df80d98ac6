// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "base/job.h"

namespace gischt {

enum class ProgressStyle { Bar, Plain, Json, None };

// What every sub-command shares. `action` is set by the sub-command that was given; its result is
// the exit status.
struct CommandContext {
    Job job;
    std::function<int()> action;
    std::string command_line;  // as typed, for metadata

    // Flags that mean the same everywhere.
    std::vector<std::string> sets;
    int threads = 0;
    std::string progress = "auto";
    std::string stats_file;
    std::string simd = "auto";
    int verbose = 0;
    bool quiet = false;
};

// Declares -v, -q, --threads, --progress, --stats on a sub-command that works for long.
void add_work_flags(CLI::App& app, CommandContext& context);

// Each sub-command lives in a file of its own.
void add_run(CLI::App& app, CommandContext& context);
void add_sim(CLI::App& app, CommandContext& context);
void add_render(CLI::App& app, CommandContext& context);
void add_check(CLI::App& app, CommandContext& context);
void add_info(CLI::App& app, CommandContext& context);
void add_merge(CLI::App& app, CommandContext& context);
void add_compare(CLI::App& app, CommandContext& context);
void add_scenes(CLI::App& app, CommandContext& context);
void add_doc(CLI::App& app, CommandContext& context);
void add_methods(CLI::App& app, CommandContext& context);

}  // namespace gischt
