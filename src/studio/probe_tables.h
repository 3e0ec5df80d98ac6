// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fluid/probes/probe.h"
#include "scene/load.h"

namespace gischt {

// The tables of one fluid's probes in a folder: NAME.csv each, with the names of the columns and
// their units in the first line, and NAME_mean.csv where the mean is wanted. A file is replaced in
// one step, so that it is always a whole table. What is measured again takes the place of what was
// measured at the same times: a simulation that was interrupted and goes on, or is repeated in
// part, leaves the bytes of one that ran through. `probes.txt` notes what each table belongs to;
// tables of another simulation or of a probe that has changed are dropped.
class ProbeTables {
  public:
    // Reads what is there. Throws Error{Input} for a file that is no table of its probe,
    // Error{Resource} when the folder cannot be written.
    ProbeTables(const LoadedScene& scene, std::size_t fluid, std::filesystem::path folder,
                bool restart);

    const std::vector<ProbeParams>& probes() const { return probes_; }
    bool is_empty() const { return probes_.empty(); }

    // Takes rows over, per probe in order of time, and writes the tables that they belong to.
    void add(const std::vector<std::vector<ProbeRow>>& rows);
    // The names of the probes, with commas, that should have a row at a frame's time, give or take
    // half a frame, and have none.
    std::string missing_at(double time, double frame_time) const;

  private:
    struct Measured {
        std::vector<std::string> columns;
        std::vector<ProbeRow> rows;
    };
    std::filesystem::path path(std::size_t probe, const char* suffix = "") const;
    void forget_others(const LoadedScene& scene, bool restart) const;
    void write(std::size_t probe) const;

    std::filesystem::path folder_;
    std::vector<ProbeParams> probes_;
    bool is_2d_ = false;
    std::vector<Measured> tables_;  // one per probe
};

// A table as text and back: numbers in the shortest form that reads as the same number.
std::string to_csv(const std::vector<std::string>& columns, const std::vector<ProbeRow>& rows);
// Throws Error{Input} at `path` when the text has other columns or is no such table.
std::vector<ProbeRow> rows_of_csv(const std::string& text, const std::vector<std::string>& columns,
                                  const std::string& path);

// The mean over time of blocks of rows of one time, each row with those in its place in the other
// blocks, by the trapezoidal rule; the time is that of the last block. Of one block: itself. A row
// that is missing in some block makes an Error{Internal}.
std::vector<ProbeRow> mean_over_time(const std::vector<ProbeRow>& rows);

}  // namespace gischt
