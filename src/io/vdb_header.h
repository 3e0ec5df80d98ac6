// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace gischt {

// One grid as the file's table of contents has it. All positions are bytes from the file's start
// and lie inside the file.
struct VdbEntry {
    std::string name;         // as the grid's author gave it
    std::string unique_name;  // the key in the file: the name, with a number where it repeats
    std::string type;         // "Tree_float_5_4_3", without the suffix for half floats
    bool is_half = false;
    int parent = -1;                 // entry whose tree this one shares, or -1
    std::uint32_t compression = 0;   // OpenVDB's flags
    std::int64_t begin = 0;          // grid's metadata
    std::int64_t data = 0, end = 0;  // transform and tree
    std::string transform;           // kind of map: UniformScaleMap, AffineMap ...
    std::map<std::string, std::string> metadata;

    // "float" for "Tree_float_5_4_3".
    std::string value_type() const;
    std::string grid_class() const;
};

struct VdbHeader {
    std::uint32_t format = 0, library_major = 0, library_minor = 0;
    std::int64_t size = 0;
    std::map<std::string, std::string> metadata;
    std::vector<VdbEntry> grids;
};

// Reads and checks everything in a VDB file but transforms and trees, so that the library behind
// read_vdb() never sees a file that is missing, of another kind, cut short or has absurd lengths in
// its table of contents. Values of metadata become text. Throws Error{Input}.
VdbHeader read_vdb_header(const std::string& path);

}  // namespace gischt
