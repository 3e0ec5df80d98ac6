// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/job.h"
#include "grid/frame.h"

namespace gischt {

// Where the value of OpenVDB's index (i,j,k) lives, T being the file's transform.
enum class HalfVoxel {
    Follow,  // at T(i,j,k), as OpenVDB and Houdini have it
    Center,  // at T(i+1/2,j+1/2,k+1/2): files that leave the half voxel out, whose T maps corners
    Auto,    // Center for files that Blender's fluid simulation (Mantaflow) made, else Follow
};

// "auto", "follow" or "center"; throws Error{Usage} with the near words otherwise.
HalfVoxel half_voxel_from(const std::string& word);

struct VdbReadOptions {
    // The grids to read, by the name in the file or the customary one; empty: all.
    std::vector<std::string> grids{};
    HalfVoxel half_voxel = HalfVoxel::Follow;
    // Give grids the customary names and units (docs/vdb.md), merge velocity_x/y/z, average
    // staggered vectors to cell centres. Without it every grid keeps its name, values and places.
    bool customary = true;
    // Values that the frame may hold, all grids together: uniform tiles of the file's tree are
    // spelled out, and a file of some bytes may stand for terabytes. 2^30 floats are 4 GiB.
    std::int64_t max_values = std::int64_t{1} << 30;
    // Also points that others wrote. The library trusts what is in them, and nothing here can check
    // it: a damaged file may end the program.
    bool foreign_points = false;
};

// Reads one .vdb file (file format 222 to 224, OpenVDB 3 and later). Grids of points become
// particles in ascending order of their ids, with positions to about 1e-7 of a voxel, where
// gischt wrote the file and nobody changed it, or options.foreign_points is set. Grid types that
// have no place in a frame (points of others ...), transforms that are not affine and grids not
// asked for are left out, the first two with a message; a grid without values is kept with an empty
// map. Numbers that are not finite become the background, with a warning. Throws Error{Input} for
// what is not a whole and sound VDB file, Error{Resource} beyond max_values. Cost: about 1 s per
// 150 MB of values.
Frame read_vdb(const std::string& path, const VdbReadOptions& options, Job& job);

struct VdbWriteOptions {
    bool half_scalars = true;   // 16-bit floats for scalars; level sets stay 32-bit
    bool half_vectors = false;  // and for vectors
    // Put the half voxel into the transform, as OpenVDB defines it. Off: transforms that map cell
    // corners, as Blender's renderer and fluid caches take them.
    bool half_voxel = true;
};

// Writes a frame: particles as grids of points, and named grids with customary metadata
// (docs/vdb.md), Blosc-compressed where the library has it. Cells equal to the background are left
// inactive. The file appears under its name when complete. The same frame gives the same bytes.
// Throws Error{Resource} when it cannot write.
void write_vdb(const std::string& path, const Frame& frame, const VdbWriteOptions& options,
               Job& job);

// What a file says about one grid, and what is in it.
struct VdbGridInfo {
    std::string name;         // as in the file
    std::string type;         // float, vec3s, ..., also of types that read_vdb() leaves out
    std::string grid_class;   // fog volume, level set, staggered, unknown
    bool is_half = false;     // stored as 16-bit floats
    bool is_readable = true;  // read_vdb() takes it; else `note` says why not
    std::string note;
    std::int64_t active_voxels = 0;
    std::array<int, 3> lo{}, hi{};  // box of active voxels, inclusive; meaningless where none is
    std::array<double, 3> voxel_size{};
    std::array<double, 3> origin{};  // where the transform puts index (0,0,0)
    // Range of the active values; of a vector the shortest and longest. min > max: there is none.
    double min = 0, max = -1;
    std::int64_t points = -1;             // how many, where it holds such that read_vdb() takes
    std::vector<std::string> attributes;  // of the points, as in the file
    std::map<std::string, std::string> metadata;
};

struct VdbInfo {
    std::uint32_t format = 0;  // of the file
    std::string library;       // version of OpenVDB that wrote it
    std::map<std::string, std::string> metadata;
    std::vector<VdbGridInfo> grids;
};

// Looks at all grids of a file without spelling out its tiles. Throws as read_vdb().
VdbInfo list_vdb(const std::string& path, Job& job);

}  // namespace gischt
