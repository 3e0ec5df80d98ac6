// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "math/keyframes.h"
#include "schema/table.h"
#include "shape/mesh_distance.h"
#include "shape/shape.h"

namespace gischt {

enum class SolidKind { Sphere, Box, Plane, Mesh };

// What solids do to the fluid along their surface.
enum class SolidSlip { FreeSlip, NoSlip };

// A solid of a scene, in metres; it moves as its keyframes say and is not moved by the fluid.
struct SolidParams {
    SolidKind kind = SolidKind::Sphere;
    Keyed<Vec3d> position;         // centre; of a plane any point
    Keyed<double> radius = 0.5;    // sphere
    Keyed<Vec3d> size = Vec3d(1);  // box: edges
    Vec3d normal{0, 0, 1};         // plane: the fluid is on this side
    Keyed<Vec3d> rotation;         // axis times angle in degrees
    // The body of a mesh, about its own origin, which lies at `position`; moved by nothing else.
    std::shared_ptr<const MeshDistance> mesh;
    Keyed<double> scale = 1.0;                 // of a mesh, about its origin, at first
    std::optional<Keyed<double>> temperature;  // K, of its surface; unset: insulated
    std::string name = {};                     // for probes

    // Throws Error{Usage} for a mesh, which is no simple shape.
    Shape shape_at(double time) const;
    // Turns the solid's own axes into the world's.
    Transform rotation_at(double time) const;
    // Velocity of its material at a point in metres, m/s; a growing sphere pushes outwards.
    Vec3d velocity_at(double time, const Vec3d& point) const;
    bool is_moving() const {
        return !(position.is_constant() && radius.is_constant() && size.is_constant() &&
                 rotation.is_constant() && scale.is_constant());
    }
};
const Table<SolidParams>& solid_table();

// Throws Error{Usage} on radii, sizes and scales that are not positive, normals without length, and
// a mesh that is missing.
void check_solid(const SolidParams& params);

// A solid at one moment.
class PlacedSolid {
  public:
    PlacedSolid(const SolidParams& params, double time);

    // Metres to the surface, negative inside.
    double signed_distance(const Vec3d& p) const;
    // The same sign, which is cheaper for a mesh.
    bool is_inside(const Vec3d& p) const;
    // A plane's is unbounded.
    Box3d bounds() const;

  private:
    Shape shape_;
    std::shared_ptr<const MeshDistance> mesh_;  // null: `shape_`
    Transform to_world_, to_mesh_;
    double scale_ = 1;
};

}  // namespace gischt
