// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "shape/mesh.h"

namespace gischt {

// What a file of triangles holds: all its parts in one mesh, placed as the file says, polygons cut
// into triangles.
struct MeshFile {
    Mesh mesh;
    // Of the first part that names one.
    std::optional<Vec3f> base_color;  // linear, in [0,1]
    std::string base_color_file;      // path; empty for none
};

// ".obj", ".ply", ".gltf", ".glb".
const std::vector<std::string>& mesh_extensions();

// Reads one by extension. Throws Error{Usage} for another extension, listing the valid ones, and
// Error{Input} for a file that is missing, broken or without triangles. Warns of colours that
// cannot be used: beyond 1, or pictures packed into the file.
MeshFile read_mesh(const std::string& path, Job& job);

}  // namespace gischt
