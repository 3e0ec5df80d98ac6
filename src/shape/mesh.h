// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "math/box.h"
#include "math/transform.h"
#include "math/vec.h"

namespace gischt {

// A surface of triangles. Seen from outside their corners run counterclockwise.
struct Mesh {
    std::vector<Vec3f> points;  // metres
    std::vector<Vec3i> triangles;
    // Each empty, or one per point.
    std::vector<Vec3f> normals;     // unit, outwards, for smooth shading
    std::vector<Vec2f> uvs;         // texture coordinates
    std::vector<Vec3f> velocities;  // m/s
};

// Moves points, turns normals and velocities (without the map's own motion). A mirroring map turns
// the triangles over, so that outside stays outside.
Mesh transformed(Mesh mesh, const Transform& map);

// Triangles without an area, and those with a point that is not finite or does not exist.
struct MeshFaults {
    std::int64_t flat = 0, not_finite = 0, no_point = 0;
    std::int64_t sum() const { return flat + not_finite + no_point; }
};
// Drops such triangles; points stay. Throws nothing.
MeshFaults remove_faults(Mesh& mesh);

// Whether each edge, points at one place being one, belongs to as many triangles one way as the
// other: then inside and outside are told apart everywhere.
bool is_closed(const Mesh& mesh);

// Volume of what a closed mesh encloses, m^3; negative when its triangles are turned inside out.
double enclosed_volume(const Mesh& mesh);
double surface_area(const Mesh& mesh);  // m^2
Box3d bounds(const Mesh& mesh);

// Appends a polygon of three or more points, cut into triangles: a fan where it is convex, else ear
// by ear. False for one of more than 1024 corners that is not convex, which would take too long.
bool add_polygon(Mesh& mesh, const std::vector<int>& corners);

// The mesh with normals that are smooth across edges whose faces meet at less than
// `crease_degrees`: at each corner the mean of the faces around, weighted by their angle there
// (Thuermer & Wuethrich 1998). Points are split where corners differ.
Mesh with_smooth_normals(const Mesh& mesh, double crease_degrees);

// Simple meshes about the origin, closed: a ball of 20 * 4^level triangles, and a cube of edge 1.
Mesh ball_mesh(double radius, int level);
Mesh cube_mesh();

}  // namespace gischt
