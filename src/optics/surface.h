// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "math/keyframes.h"
#include "math/ray.h"
#include "schema/table.h"

namespace gischt {

// An opaque Lambert surface that may glow.
struct Material {
    Vec3d albedo{0.5, 0.5, 0.5};            // share of light reflected, per channel, in [0,1]
    Vec3d checker{0.5, 0.5, 0.5};           // albedo of every other field of a checker board
    double checker_size = 0;                // m, edge of a field; 0: no checker board
    Keyed<Vec3d> emission{Vec3d{0, 0, 0}};  // W/(m^2 sr)
};

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

// Where a ray meets a surface.
struct SurfaceHit {
    double t = 0;    // in lengths of the ray's direction
    Vec3d point;     // metres
    Vec3d normal;    // unit, on the side that the ray comes from
    Vec3f albedo;    // Lambert: the reflected radiance is albedo / pi times the irradiance
    Vec3f emission;  // W/(m^2 sr)
    int surface = 0;
};

// The surfaces of a view at one moment. Immutable; copies share their content.
class SurfaceSet {
  public:
    SurfaceSet() = default;  // no surface
    // Throws Error{Usage} on a size that is not positive.
    SurfaceSet(const std::vector<SurfaceParams>& surfaces, double time,
               const Vec3d& scene_up = {0, 0, 1});

    bool is_empty() const { return !content_; }
    int size() const;
    // The nearest hit in [t_min, t_max].
    std::optional<SurfaceHit> intersect(const Ray& ray) const;
    // Whether anything is hit in [t_min, t_max]: the shadow test.
    bool is_blocked(const Ray& ray) const;
    // Box around the finite surfaces, empty when there are none.
    Box3d bounds() const;

  private:
    struct Content;
    std::shared_ptr<const Content> content_;
};

// A ray from a point of a surface that does not hit that surface again by rounding: starts a
// little (1e-6 of the point's size) off the surface on the side of the normal.
Ray leaving_ray(const SurfaceHit& hit, const Vec3d& direction);

}  // namespace gischt
