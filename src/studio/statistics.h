// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fluid/source.h"
#include "render/method.h"

namespace gischt {

// One simulated frame of one fluid.
struct FrameFigures {
    std::string fluid;
    int frame = 0;
    double time = 0;  // s
    FrameStatistics figures;
};

// One rendered picture.
struct ImageFigures {
    std::string file, method;
    int frame = 0, width = 0, height = 0;
    RenderStatistics figures;
};

// The figures of a run, for --stats.
struct RunStatistics {
    std::string command, scene_hash;
    std::vector<FrameFigures> frames;
    std::vector<ImageFigures> images;
};

// The ledger of two spans of time, the second following the first.
ScalarLedger added_up(const ScalarLedger& a, const ScalarLedger& b);

// For people: the ledgers of each simulated fluid over the frames of the run; empty where nothing
// was simulated.
std::string ledger_text(const RunStatistics& run);

// Writes them as JSON, with the phases and wall time of the job, threads and peak memory. Throws
// Error{Resource}.
void write_statistics(const std::string& path, const RunStatistics& run, const Job& job,
                      double wall_seconds);

}  // namespace gischt
