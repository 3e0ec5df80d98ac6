// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "grid/particles.h"
#include "shape/mesh.h"

namespace gischt {

// Reads a Polygon File Format mesh (Turk 1994), ASCII or binary of either order. Takes of its
// points x, y, z, normals nx, ny, nz, coordinates (s, t), (u, v) or (texture_u, texture_v) and
// velocities vx, vy, vz; of its faces the list vertex_indices or vertex_index. Throws Error{Input}
// for what is no such file, truncated, broken or without faces, and for an index of a point that
// does not exist.
Mesh read_ply(const std::string& path);

// The points of such a file as particles: x, y, z; velocities vx, vy, vz; age, life; radius (or
// pscale, as Houdini calls it); id; opacity; temperature; colours red, green, blue where they are
// floats (linear; those of 8 bits are left out). What is missing is 0, the radius 0.01 m, the life
// infinite, the id the number of the point. Other elements are left out. Throws as read_ply(), and
// Error{Input} for a number that is not finite (but a life).
Particles read_ply_particles(const std::string& path);

// Writes particles under the names that the reader knows, binary and little-endian: positions and
// the id as doubles (PLY has no whole numbers of 64 bits; exact below 2^53), the rest as floats.
// The file appears when complete. Throws Error{Resource} when it cannot write.
void write_ply_particles(const std::string& path, const Particles& particles);

}  // namespace gischt
