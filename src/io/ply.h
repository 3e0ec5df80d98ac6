// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "shape/mesh.h"

namespace gischt {

// Reads a Polygon File Format mesh (Turk 1994), ASCII or binary of either order. Takes of its
// points x, y, z, normals nx, ny, nz, coordinates (s, t), (u, v) or (texture_u, texture_v) and
// velocities vx, vy, vz; of its faces the list vertex_indices or vertex_index. Throws Error{Input}
// for what is no such file, truncated, broken or without faces, and for an index of a point that
// does not exist.
Mesh read_ply(const std::string& path);

}  // namespace gischt
