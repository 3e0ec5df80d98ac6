// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace gischt
