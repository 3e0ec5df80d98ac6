// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/vdb_header.h"

namespace gischt {

// The program that made a VDB file, as far as its names and units depend on it.
enum class VdbOrigin { Unknown, Gischt, Mantaflow, Houdini, EmberGen };

// From the metadata of the file and of its grids.
VdbOrigin vdb_origin(const VdbHeader& header);

struct VdbName {
    std::string name;
    bool is_vector = false;
};

// The customary name of each grid, in the order of `grids`, its own where it has none: density,
// temperature, flame, velocity by their aliases (docs/vdb.md), upper and lower case alike. A grid
// that bears the customary name comes before all aliases; of two aliases for one quantity the first
// of the alias table wins and the other keeps its own name. Repeated names get _2, _3 ...
std::vector<std::string> customary_names(const std::vector<VdbName>& grids, VdbOrigin origin);

// The grids' own names, repeated ones numbered.
std::vector<std::string> unique_names(const std::vector<VdbName>& grids);

// Indices of three scalar grids that are the components x, y, z of the velocity: velocity_x,
// velocity.x, vel.x, vel_x, v_x, velx, u v w ... Nothing when a vector grid is the velocity.
std::optional<std::array<int, 3>> velocity_components(const std::vector<VdbName>& grids);

// What the numbers of a temperature grid are.
struct TemperatureUnit {
    std::string unit;  // "K", or "relative": 0 is ambient and about 1 hot
    float offset = 0;  // added to the stored numbers; 273.15 for degrees Celsius
    std::string why;   // for the message to the user
};

// From the unit that grid metadata names, else the origin, else the magnitude: no hot gas has a
// largest temperature below 150 K and no relative scale in use goes beyond 150.
TemperatureUnit temperature_unit(const std::map<std::string, std::string>& grid_metadata,
                                 VdbOrigin origin, float largest);

// The unit of a customary field for the file's metadata: "K" or the frame's temperature_unit for
// temperature, "m/s", "1", "Pa"; empty for fields of no custom.
std::string unit_of(const std::string& field, const std::map<std::string, std::string>& metadata);

}  // namespace gischt
