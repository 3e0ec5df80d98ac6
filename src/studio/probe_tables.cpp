// SPDX-License-Identifier: Apache-2.0
#include "studio/probe_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/hash.h"
#include "io/atomic_file.h"
#include "schema/toml.h"

namespace gischt {
namespace fs = std::filesystem;
namespace {

constexpr const char* index_name = "probes.txt";

void write_text(const fs::path& path, const std::string& text) {
    AtomicFile file(path.string());
    file.write(std::span<const char>(text));
    file.commit();
}

std::string read_text(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw Error(ErrorKind::Input, path.string(), "cannot be read");
    return text.str();
}

// What a table belongs to: the simulation and the probe.
std::string mark_of(const LoadedScene& scene, const ProbeParams& probe) {
    return hex(hash_bytes(scene.motion_hash + to_inline_toml(to_value(probe, probe_variants()))));
}

// Lines "MARK NAME".
std::map<std::string, std::string> read_index(const fs::path& folder) {
    std::map<std::string, std::string> marks;
    std::ifstream in(folder / index_name);
    for (std::string line; std::getline(in, line);) {
        const std::size_t space = line.find(' ');
        if (space != std::string::npos) marks[line.substr(space + 1)] = line.substr(0, space);
    }
    return marks;
}

}  // namespace

std::string to_csv(const std::vector<std::string>& columns, const std::vector<ProbeRow>& rows) {
    std::string text = fmt::format("{}\n", fmt::join(columns, ","));
    for (const ProbeRow& row : rows) text += fmt::format("{}\n", fmt::join(row, ","));
    return text;
}

std::vector<ProbeRow> rows_of_csv(const std::string& text, const std::vector<std::string>& columns,
                                  const std::string& path) {
    std::istringstream in(text);
    std::string line;
    std::getline(in, line);
    int number = 1;
    const auto bad = [&](const std::string& what) {
        return Error(ErrorKind::Input, fmt::format("{}:{}", path, number), what,
                     "remove the file, or start with --restart");
    };
    if (line != fmt::format("{}", fmt::join(columns, ","))) {
        throw bad("these are not the columns of the probe of that name");
    }
    std::vector<ProbeRow> rows;
    while (std::getline(in, line)) {
        ++number;
        ProbeRow& row = rows.emplace_back();
        for (const char *at = line.data(), *end = at + line.size();; ++at) {
            const auto [rest, error] = std::from_chars(at, end, row.emplace_back());
            if (error != std::errc() || (rest != end && *rest != ',')) throw bad("is no number");
            at = rest;
            if (at == end) break;
        }
        if (row.size() != columns.size()) throw bad("has not one number for each column");
        if (rows.size() > 1 && !(row[0] >= rows[rows.size() - 2][0])) {
            throw bad("lies before the line above in time");
        }
    }
    return rows;
}

std::vector<ProbeRow> mean_over_time(const std::vector<ProbeRow>& rows) {
    std::vector<std::size_t> begins;  // of the blocks
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (i == 0 || rows[i][0] != rows[i - 1][0]) begins.push_back(i);
    }
    if (begins.empty()) return {};
    const std::size_t height = begins.size() > 1 ? begins[1] : rows.size();
    if (rows.size() != begins.size() * height) {
        throw Error(ErrorKind::Internal, "probe", "a moment has fewer rows than another");
    }
    // The weight of a moment: half the time between its neighbours.
    std::vector<double> weights(begins.size(), 1.0);
    const auto time = [&](std::size_t block) { return rows[begins[block]][0]; };
    for (std::size_t b = 0; b < begins.size() && begins.size() > 1; ++b) {
        const std::size_t before = b == 0 ? b : b - 1, after = std::min(b + 1, begins.size() - 1);
        weights[b] = 0.5 * (time(after) - time(before));
    }
    double total = 0;
    for (const double w : weights) total += w;
    std::vector<ProbeRow> mean(height, ProbeRow(rows[0].size(), 0.0));
    for (std::size_t b = 0; b < begins.size(); ++b) {
        for (std::size_t i = 0; i < height; ++i) {
            const ProbeRow& row = rows[begins[b] + i];
            for (std::size_t c = 1; c < row.size(); ++c) mean[i][c] += weights[b] / total * row[c];
        }
    }
    for (ProbeRow& row : mean) row[0] = rows.back()[0];
    return mean;
}

ProbeTables::ProbeTables(const LoadedScene& scene, std::size_t fluid, fs::path folder, bool restart)
    : folder_(std::move(folder)), probes_(probes_of(scene.scene, fluid)) {
    if (probes_.empty()) return;
    const auto& smoke = std::get<FluidOf<SmokeParams>>(scene.scene.fluids[fluid]).source;
    is_2d_ = smoke.domain.min.z == smoke.domain.max.z;
    forget_others(scene, restart);
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        Measured& table = tables_.emplace_back();
        table.columns = probe_columns(probes_[i], is_2d_);
        std::error_code ignored;
        if (!fs::exists(path(i), ignored)) continue;
        table.rows = rows_of_csv(read_text(path(i)), table.columns, path(i).string());
    }
}

fs::path ProbeTables::path(std::size_t probe, const char* suffix) const {
    return folder_ / (probe_common(probes_[probe]).name + suffix + ".csv");
}

void ProbeTables::forget_others(const LoadedScene& scene, bool restart) const {
    auto marks = read_index(folder_);
    const auto before = marks;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        std::string& mark = marks[probe_common(probes_[i]).name];
        const std::string own = mark_of(scene, probes_[i]);
        if (mark == own && !restart) continue;
        mark = own;
        std::error_code ignored;
        fs::remove(path(i), ignored);
        fs::remove(path(i, "_mean"), ignored);
    }
    if (marks == before) return;
    std::string text;
    for (const auto& [name, mark] : marks) text += mark + " " + name + "\n";
    write_text(folder_ / index_name, text);
}

void ProbeTables::add(const std::vector<std::vector<ProbeRow>>& rows) {
    for (std::size_t i = 0; i < std::min(rows.size(), probes_.size()); ++i) {
        if (rows[i].empty()) continue;
        auto& table = tables_[i].rows;
        const auto earlier = [](const ProbeRow& row, double time) { return row[0] < time; };
        const auto later = [](double time, const ProbeRow& row) { return time < row[0]; };
        const auto from = std::lower_bound(table.begin(), table.end(), rows[i].front()[0], earlier);
        const auto to = std::upper_bound(from, table.end(), rows[i].back()[0], later);
        table.insert(table.erase(from, to), rows[i].begin(), rows[i].end());
        write(i);
    }
}

void ProbeTables::write(std::size_t probe) const {
    const Measured& table = tables_[probe];
    write_text(path(probe), to_csv(table.columns, table.rows));
    if (!probe_common(probes_[probe]).mean) return;
    std::vector<ProbeRow> mean = mean_over_time(table.rows);
    for (ProbeRow& row : mean) complete_mean(probes_[probe], is_2d_, row);
    write_text(path(probe, "_mean"), to_csv(table.columns, mean));
}

std::string ProbeTables::missing_at(double time, double frame_time) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        const ProbeCommon& p = probe_common(probes_[i]);
        const double slack = 0.5 * frame_time;
        if (time < p.start.value_or(0) - 1e-6 * frame_time) continue;
        if (p.stop && time > *p.stop + 1e-6 * frame_time) continue;
        const auto& rows = tables_[i].rows;
        const auto after = std::partition_point(
            rows.begin(), rows.end(), [&](const ProbeRow& row) { return row[0] < time - slack; });
        const bool found = after != rows.end() && (*after)[0] < time + slack;
        if (!found) names.push_back(p.name);
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace gischt
