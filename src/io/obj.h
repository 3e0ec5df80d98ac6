// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "io/mesh_file.h"

namespace gischt {

// Reads the polygons of a Wavefront OBJ file (.obj), and of the material libraries that it names
// the color (Kd, map_Kd) of the first material in use that has one. Corners that agree in place,
// texture coordinates and normal share a point; normals and texture coordinates are kept where all
// corners have them. Lines, points, groups and whatever else the file holds are passed over. A
// library that cannot be read is warned of. Throws Error{Input} with the line for indices of what
// is not there, and numbers that are none or not finite. Our own reader, since libraries crash on
// broken files.
MeshFile read_obj(const std::string& path, Job& job);

}  // namespace gischt
