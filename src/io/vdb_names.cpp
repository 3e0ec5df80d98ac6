// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "base/error.h"
#include "io/vdb.h"

namespace gischt {

namespace {

struct Alias {
    const char* alias;
    const char* name;
    bool is_vector = false;
};

// For one quantity the best alias first. `heat` is special, see alias_table().
constexpr Alias common_aliases[] = {
    {"density", "density"},
    {"smoke", "density"},
    {"soot", "density"},
    {"temperature", "temperature"},
    {"temp", "temperature"},
    {"flame", "flame"},
    {"flames", "flame"},
    {"fire", "flame"},
    {"velocity", "velocity", true},
    {"vel", "velocity", true},
    {"v", "velocity", true},
};

// Houdini's `heat` is the intensity of burning (1 fresh, 0 burnt out), everyone else's is a
// temperature above ambient.
std::vector<Alias> alias_table(VdbOrigin origin) {
    std::vector<Alias> table(std::begin(common_aliases), std::end(common_aliases));
    table.push_back({"heat", origin == VdbOrigin::Houdini ? "flame" : "temperature"});
    return table;
}

std::string lower(std::string word) {
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return word;
}

std::string value_of(const std::map<std::string, std::string>& metadata, const char* key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
}

// The stem before x, y, z that names velocity, with each way to attach the axis.
std::vector<std::array<std::string, 3>> component_names() {
    std::vector<std::array<std::string, 3>> out;
    for (const char* stem : {"velocity", "vel", "v"}) {
        for (const char* joint : {"_", ".", ""}) {
            const std::string s = std::string(stem) + joint;
            out.push_back({s + "x", s + "y", s + "z"});
        }
    }
    out.push_back({"u", "v", "w"});
    return out;
}

// Gives the grids without a name their own, numbered where it is taken.
void fill_own_names(const std::vector<VdbName>& grids, std::set<std::string>& taken,
                    std::vector<std::string>& out) {
    for (std::size_t g = 0; g < grids.size(); ++g) {
        if (!out[g].empty()) continue;
        const std::string own = grids[g].name.empty() ? "unnamed" : grids[g].name;
        out[g] = own;
        for (int n = 2; !taken.insert(out[g]).second; ++n) out[g] = fmt::format("{}_{}", own, n);
    }
}

}  // namespace

VdbOrigin vdb_origin(const VdbHeader& header) {
    const std::string creator = lower(value_of(header.metadata, "creator"));
    if (creator.starts_with("gischt")) return VdbOrigin::Gischt;
    if (creator.starts_with("houdini")) return VdbOrigin::Houdini;
    for (const VdbEntry& entry : header.grids) {
        const auto& metadata = entry.metadata;
        if (metadata.contains("embergen_version")) return VdbOrigin::EmberGen;
        // Mantaflow names no creator, but these two are its own.
        if (metadata.contains("file_base_resolution") && metadata.contains("file_voxel_size")) {
            return VdbOrigin::Mantaflow;
        }
        if (lower(value_of(metadata, "creator")).starts_with("houdini")) return VdbOrigin::Houdini;
    }
    return VdbOrigin::Unknown;
}

std::vector<std::string> customary_names(const std::vector<VdbName>& grids, VdbOrigin origin) {
    std::vector<std::string> out(grids.size());
    std::set<std::string> taken;
    for (const Alias& a : alias_table(origin)) {
        for (std::size_t g = 0; g < grids.size(); ++g) {
            const bool fits = grids[g].is_vector == a.is_vector && lower(grids[g].name) == a.alias;
            if (fits && out[g].empty() && taken.insert(a.name).second) out[g] = a.name;
        }
    }
    fill_own_names(grids, taken, out);
    return out;
}

std::vector<std::string> unique_names(const std::vector<VdbName>& grids) {
    std::vector<std::string> out(grids.size());
    std::set<std::string> taken;
    fill_own_names(grids, taken, out);
    return out;
}

std::optional<std::array<int, 3>> velocity_components(const std::vector<VdbName>& grids) {
    const std::set<std::string> vectors{"velocity", "vel", "v"};
    std::map<std::string, int> scalars;
    for (std::size_t g = 0; g < grids.size(); ++g) {
        const std::string name = lower(grids[g].name);
        if (grids[g].is_vector && vectors.contains(name)) return std::nullopt;
        if (!grids[g].is_vector) scalars.emplace(name, static_cast<int>(g));
    }
    for (const auto& names : component_names()) {
        std::array<int, 3> found{};
        bool all = true;
        for (std::size_t a = 0; a < 3; ++a) {
            const auto at = scalars.find(names[a]);
            all = all && at != scalars.end();
            if (all) found[a] = at->second;
        }
        if (all) return found;
    }
    return std::nullopt;
}

TemperatureUnit temperature_unit(const std::map<std::string, std::string>& grid_metadata,
                                 VdbOrigin origin, float largest) {
    constexpr float coldest_maximum = 150;  // K
    for (const char* key : {"unit", "units"}) {
        const std::string unit = lower(value_of(grid_metadata, key));
        if (unit == "k" || unit == "kelvin") return {"K", 0, "the file says kelvin"};
        if (unit == "c" || unit == "celsius" || unit == "degc") {
            return {"K", 273.15f, "the file says degrees Celsius"};
        }
        if (unit == "relative") return {"relative", 0, "the file says relative"};
    }
    if (origin == VdbOrigin::Mantaflow) return {"relative", 0, "Mantaflow's heat"};
    if (largest >= coldest_maximum) {
        return {"K", 0, fmt::format("its largest value is {:.4g}", largest)};
    }
    return {"relative", 0, fmt::format("its largest value is {:.4g}", largest)};
}

std::string unit_of(const std::string& field, const std::map<std::string, std::string>& metadata) {
    if (field == "density" || field == "flame") return "1";
    if (field == "velocity") return "m/s";
    if (field == "pressure") return "Pa";
    if (field != "temperature") return {};
    const std::string stated = value_of(metadata, "temperature_unit");
    return stated.empty() ? "K" : stated;
}

HalfVoxel half_voxel_from(const std::string& word) {
    if (word == "auto") return HalfVoxel::Auto;
    if (word == "follow") return HalfVoxel::Follow;
    if (word == "center") return HalfVoxel::Center;
    const std::vector<std::string> valid{"auto", "follow", "center"};
    throw Error(ErrorKind::Usage, "half_voxel", fmt::format("'{}' is not a choice", word),
                hint_for(word, valid));
}

}  // namespace gischt
