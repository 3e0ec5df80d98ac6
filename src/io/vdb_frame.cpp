// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/parallel.h"
#include "io/vdb_grid.h"
#include "io/vdb_names.h"

namespace gischt {

namespace {

// Metadata that the library keeps about its own storage, or that the fields themselves hold.
bool is_bookkeeping(const std::string& key) {
    for (const char* k : {"class", "name", "is_saved_as_half_float", "is_local_space", "value_type",
                          "vector_type"}) {
        if (key == k) return true;
    }
    return key.starts_with("file_") || key.starts_with("gischt_");
}

template <class T>
bool number_from(const std::map<std::string, std::string>& metadata, const char* key, T& out) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) return false;
    const std::string& text = found->second;
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end == text.data()) return false;
    out = value;
    return true;
}

// The four or more digits that end the file's stem: smoke_0042.vdb is frame 42, while smoke_64.vdb
// is as likely a resolution.
int number_in_name(const std::string& path) {
    const std::string stem = std::filesystem::path(path).stem().string();
    std::size_t first = stem.size();
    while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') --first;
    int number = 0;
    if (stem.size() - first < 4) return number;
    std::from_chars(stem.data() + first, stem.data() + stem.size(), number);
    return number;
}

void set_time(Frame& frame, const VdbHeader& header, const std::string& path) {
    const auto& m = frame.metadata;
    if (!number_from(m, "frame", frame.number)) frame.number = number_in_name(path);
    if (!number_from(m, "seconds", frame.time) && !number_from(m, "time", frame.time)) {
        for (const VdbEntry& e : header.grids) {  // EmberGen's
            if (number_from(e.metadata, "simulation_time", frame.time)) break;
        }
    }
    double fps = 0;
    if (!number_from(m, "dt", frame.dt) && number_from(m, "fps", fps) && fps > 0) {
        frame.dt = 1 / fps;
    }
}

void for_values(Field& field, const auto& f) {
    for (std::size_t c = 0; c < field.component.size(); ++c) {
        TileField<float>& component = field.component[c];
        parallel_for(component.map().size(), 64, [&](int t) {
            float* values = component.tile(t);
            for (int m = 0; m < tile_values; ++m) values[m] = f(values[m]);
        });
        field.background[c] = f(field.background[c]);
    }
}

float largest_value(const Field& field) {
    float largest = field.background[0];
    for (const float v : field.component[0].values()) largest = std::max(largest, v);
    return largest;
}

// Kelvin where the numbers are a temperature; a relative heat is kept and flagged.
void settle_temperature(VdbGrid& grid, VdbOrigin origin, Frame& frame, Job& job) {
    const TemperatureUnit unit = temperature_unit(grid.metadata, origin, largest_value(grid.field));
    if (unit.offset != 0) for_values(grid.field, [&](float v) { return v + unit.offset; });
    frame.metadata["temperature_unit"] = unit.unit;
    job.info(fmt::format("grid '{}' is taken as {}: {}", grid.name,
                         unit.unit == "K" ? "kelvin" : "relative heat", unit.why));
}

// Mantaflow counts velocity in cells per unit of its own time, of which 2.5 make a second at time
// scale 1 (its frame is 0.1 at 25 frames/s); everyone else in metres per second.
void settle_velocity(VdbGrid& grid, VdbOrigin origin, Frame& frame, Job& job) {
    constexpr double mantaflow_time = 2.5;  // units per second
    if (origin == VdbOrigin::Mantaflow) {
        const auto scale = static_cast<float>(mantaflow_time * grid.field.cell_size());
        for_values(grid.field, [scale](float v) { return v * scale; });
        job.info(
            fmt::format("grid '{}' is taken as Mantaflow's cells per time unit: times {:.4g} "
                        "for metres per second",
                        grid.name, scale));
    }
    frame.metadata["velocity_unit"] = "m/s";
}

// Three scalar grids become the last of the list, as "velocity".
void merge_velocity(std::vector<VdbGrid>& grids, Job& job) {
    std::vector<VdbName> names;
    for (const VdbGrid& g : grids) names.push_back({g.name, g.field.is_vector()});
    const auto found = velocity_components(names);
    if (!found) return;
    std::array<const Field*, 3> parts{};
    std::string list;
    for (std::size_t a = 0; a < 3; ++a) {
        const VdbGrid& part = grids[static_cast<std::size_t>((*found)[a])];
        parts[a] = &part.field;
        list += (a ? ", " : "") + part.name;
    }
    auto field = merge_components(parts);
    if (!field) {
        job.warn(fmt::format("grids {} do not lie on one lattice: not taken as velocity", list));
        return;
    }
    VdbGrid merged;
    merged.name = "velocity";
    merged.field = std::move(*field);
    merged.metadata = grids[static_cast<std::size_t>((*found)[0])].metadata;
    auto order = *found;
    std::ranges::sort(order, std::greater<>());
    for (const int g : order) grids.erase(grids.begin() + g);
    grids.push_back(std::move(merged));
    job.info(fmt::format("grids {} are taken as the components of velocity", list));
}

void report(const VdbGrid& grid, Job& job) {
    if (grid.field.map().size() == 0) job.info(fmt::format("grid '{}' is empty", grid.name));
    if (grid.bad_values > 0) {
        job.warn(fmt::format("grid '{}': {} values are not finite and taken as background {}",
                             grid.name, grid.bad_values, grid.field.background[0]));
    }
}

void keep_metadata(const VdbGrid& grid, const std::string& name, Frame& frame) {
    for (const auto& [key, value] : grid.metadata) {
        if (!is_bookkeeping(key)) frame.metadata.emplace(name + "." + key, value);
    }
}

}  // namespace

Frame assemble_frame(std::vector<VdbGrid> grids, const VdbHeader& header, const std::string& path,
                     bool customary, Job& job) {
    Frame frame;
    frame.metadata = header.metadata;
    set_time(frame, header, path);
    const VdbOrigin origin = vdb_origin(header);
    if (origin == VdbOrigin::Mantaflow) frame.metadata.emplace("up", "z");  // Blender's axes
    for (const VdbGrid& grid : grids) report(grid, job);

    // Vectors to cell centres, then names, then units.
    if (customary) {
        for (VdbGrid& grid : grids) {
            if (grid.is_staggered) center_components(grid.field);
        }
        merge_velocity(grids, job);
    }
    std::vector<VdbName> names;
    for (const VdbGrid& g : grids) names.push_back({g.name, g.field.is_vector()});
    const std::vector<std::string> final_names =
        customary ? customary_names(names, origin) : unique_names(names);
    for (std::size_t g = 0; g < grids.size(); ++g) {
        const std::string& name = final_names[g];
        if (customary && name == "temperature") settle_temperature(grids[g], origin, frame, job);
        if (customary && name == "velocity") settle_velocity(grids[g], origin, frame, job);
        keep_metadata(grids[g], name, frame);
        frame.fields.emplace(name, std::move(grids[g].field));
    }
    return frame;
}

}  // namespace gischt
