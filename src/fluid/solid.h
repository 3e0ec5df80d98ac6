// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "math/keyframes.h"
#include "schema/table.h"
#include "shape/shape.h"

namespace gischt {

enum class SolidKind { Sphere, Box, Plane };

// A solid of a scene, in metres; it moves as its keyframes say and is not moved by the fluid.
struct SolidParams {
    SolidKind kind = SolidKind::Sphere;
    Keyed<Vec3d> position;         // centre; of a plane any point
    Keyed<double> radius = 0.5;    // sphere
    Keyed<Vec3d> size = Vec3d(1);  // box: edges
    Vec3d normal{0, 0, 1};         // plane: the fluid is on this side
    Keyed<Vec3d> rotation;         // axis times angle in degrees
    std::string name = {};         // for probes

    Shape shape_at(double time) const;
    // Turns the solid's own axes into the world's.
    Transform rotation_at(double time) const;
    // Velocity of its material at a point in metres, m/s; a growing sphere pushes outwards.
    Vec3d velocity_at(double time, const Vec3d& point) const;
    bool is_moving() const {
        return !(position.is_constant() && radius.is_constant() && size.is_constant() &&
                 rotation.is_constant());
    }
};
const Table<SolidParams>& solid_table();

// Throws Error{Usage} on radii and sizes that are not positive and normals without length.
void check_solid(const SolidParams& params);

}  // namespace gischt
