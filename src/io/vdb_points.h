// SPDX-License-Identifier: Apache-2.0
#pragma once

// Particles to grids of points of OpenVDB and back. Part of the door of vdb.cpp; a file of its own
// because the library's headers for points take longest to compile.

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

#include "grid/particles.h"

namespace gischt::vdb_detail {

// Whether a grid of this type in a file holds points.
bool is_point_type(const std::string& type);

// Positions (relative to voxels of the given edge in metres, as 32-bit floats) and attributes by
// the names of Houdini: v, age, life, pscale, id, Cd, Alpha, temperature.
openvdb::GridBase::Ptr to_point_grid(const Particles& particles, const std::string& name,
                                     double voxel_size);

// The particles in ascending order of their ids; the library keeps no order. Attributes that are
// missing are 0, the radius 0.01 m, the life infinite, all ids the number in the file. Throws
// std::exception for a grid that is no points, for attributes of other types (ids may have 32 bits)
// and for positions that are not finite.
Particles from_point_grid(const openvdb::GridBase& grid);

struct PointGridInfo {
    std::int64_t count = 0;
    std::vector<std::string> attributes;  // but the position, in alphabetical order
};
PointGridInfo describe_points(const openvdb::GridBase& grid);

}  // namespace gischt::vdb_detail
