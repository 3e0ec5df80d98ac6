// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "math/keyframes.h"
#include "optics/material.h"
#include "schema/table.h"

namespace gischt {

// The solids of a scene file, in metres.
struct SphereSurface {
    std::string name;
    Keyed<Vec3d> center{Vec3d{0, 0, 0}};
    Keyed<double> radius{1};
    Material material;
};
struct BoxSurface {
    std::string name;
    Keyed<Vec3d> center{Vec3d{0, 0, 0}};
    Vec3d size{1, 1, 1};
    Keyed<Vec3d> rotation_degrees{Vec3d{0, 0, 0}};  // around x, then y, then z
    Material material;
};
// Everything below a plane: the ground.
struct GroundSurface {
    std::string name;
    Keyed<Vec3d> point{Vec3d{0, 0, 0}};
    std::optional<Vec3d> normal;  // unset: the scene's up axis
    Material material;
};
// Thin sheets, which shine to the side of their normal only unless `two_sided`.
struct SheetPlace {
    std::string name;
    Keyed<Vec3d> center{Vec3d{0, 0, 0}};
    std::optional<Keyed<Vec3d>> target;  // a point that the sheet faces, in place of normal
    Vec3d normal{0, 0, 1};
    bool two_sided = false;
    Material material;
};
struct RectSurface : SheetPlace {
    Vec2d size{1, 1};         // along the horizontal edge, and across
    double roll_degrees = 0;  // around the normal
};
struct DiscSurface : SheetPlace {
    double radius = 0.5;
};
enum class FileUp { Y, Z };
// Triangles from a file. Smoke flows around closed ones.
struct MeshSurface {
    std::string name;
    std::string file;
    FileUp up = FileUp::Y;  // the axis that points up in the file; turned to the scene's
    Keyed<Vec3d> translate{Vec3d{0, 0, 0}};       // m, applied last
    Keyed<Vec3d> rotate_degrees{Vec3d{0, 0, 0}};  // around x, then y, then z, about the origin
    Keyed<double> scale{1};                       // about the origin, applied first
    std::optional<double> smooth_degrees;         // unset: the file's normals; 0: flat faces
    Material material;
};
using SurfaceParams =
    std::variant<SphereSurface, BoxSurface, GroundSurface, RectSurface, DiscSurface, MeshSurface>;

const Table<Material>& material_table();
const Variants<SurfaceParams>& surface_variants();

}  // namespace gischt
