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
using SurfaceParams = std::variant<SphereSurface, BoxSurface, GroundSurface>;

const Variants<SurfaceParams>& surface_variants();

}  // namespace gischt
