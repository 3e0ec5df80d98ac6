// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "math/ray.h"
#include "optics/bsdf.h"

namespace gischt {

class Medium;          // optics/medium.h
struct SphereSurface;  // optics/surface_params.h
struct BoxSurface;
struct GroundSurface;
struct RectSurface;
struct DiscSurface;
struct MeshSurface;
using SurfaceParams =
    std::variant<SphereSurface, BoxSurface, GroundSurface, RectSurface, DiscSurface, MeshSurface>;
class SurfaceLight;       // optics/surface_light.h
enum class MaterialKind;  // optics/material.h

// Where a ray meets a surface.
struct SurfaceHit {
    double t = 0;          // in lengths of the ray's direction
    Vec3d point;           // metres
    Vec3d normal;          // unit, of the geometry, on the side that the ray comes from
    Vec3d shading_normal;  // unit, on the same side; a mirror there reflects the ray to this side
    bool front = true;     // the ray came from outside
    Vec2d uv;              // sphere: longitude, latitude; box: over a face; ground: metres
    Vec3f albedo;          // share of light reflected, with checker board and texture
    Vec3f emission;        // W/(m^2 sr), towards the ray
    int surface = 0;       // which of the set
    int primitive = 0;     // triangle of a mesh, face of a box
    double offset = 1e-9;  // m; so far off the point a new ray cannot meet this surface again
};

enum class RayKind { Camera, Other };

// What is the same all over a surface.
struct SurfaceInfo {
    std::string name;
    MaterialKind material{};
    Vec3f emission;          // W/(m^2 sr)
    bool two_sided = true;   // shines to both sides; false for sheets that shine to their front
    bool is_sheet = false;   // without an inside: a rectangle, a disc, a mesh that is not closed
    bool is_moving = false;  // while the film is exposed
    bool is_lamp = false;    // stands for a light of the scene, not for a solid
    bool holdout = false, shadow_catcher = false, camera_visible = true;

    // The inside of a dielectric or of a boundary of material None (optics/interior.h).
    bool has_interior = false;
    int priority = 0;
    double ior = 1;
    std::shared_ptr<const Medium> medium;  // what fills it; null: nothing
};

// The surfaces of a view while the film is exposed. Immutable; copies share their content; safe to
// use from several threads.
class SurfaceSet {
  public:
    SurfaceSet() = default;  // no surface
    // The surfaces during [time - shutter / 2, time + shutter / 2]. Throws Error{Usage} on a size
    // that is not positive, and where a file is needed: those are loaded by a SurfaceRig.
    SurfaceSet(const std::vector<SurfaceParams>& surfaces, double time,
               const Vec3d& scene_up = {0, 0, 1}, double shutter = 0);

    bool is_empty() const { return !content_; }
    int size() const;
    const SurfaceInfo& info(int surface) const;
    // Whether a medium fills a surface, and so is nowhere else.
    bool is_interior(const Medium* medium) const;

    // The nearest hit in [t_min, t_max]; `moment` is the time as a share of the shutter. Camera
    // rays pass surfaces that are not camera_visible.
    std::optional<SurfaceHit> intersect(const Ray& ray, float moment = 0.5f,
                                        RayKind kind = RayKind::Other) const;
    // Whether anything is hit in [t_min, t_max] that light cannot pass: the shadow test. Surfaces
    // of material None block nothing, dielectrics do.
    bool is_blocked(const Ray& ray, float moment = 0.5f) const;
    // What the surface does to light there. `relative_ior` is the index of refraction on the far
    // side over that on the ray's side, as InteriorStack tells; 0: the material's own against
    // vacuum. The set must outlive the result.
    Bsdf bsdf(const SurfaceHit& hit, double relative_ior = 0) const;
    // Where the point of the surface that is hit at a moment is at another time, in metres: by its
    // keyframes and the velocities of a mesh. Takes a transform or two.
    Vec3d carried_to(double time, const SurfaceHit& hit, float moment) const;
    // The surfaces with an interior that a point lies in, outer before inner, each as often as it
    // does so (a mesh that overlaps itself may count twice).
    std::vector<int> interiors_at(const Vec3d& point, float moment = 0.5f) const;

    // The finite surfaces that glow, as lights to sample. Those that move while the film is exposed
    // are not among them: light paths can only find them.
    const std::vector<std::shared_ptr<const SurfaceLight>>& lights() const;
    // The one that a surface is, as its place among lights(); -1 for none.
    int light_of(int surface) const;

    // Box around the finite surfaces, empty when there are none.
    Box3d bounds() const;
    // Box around one surface, infinite for a ground; of a mesh that around all meshes.
    Box3d bounds_of(int surface) const;

    struct Content;  // surface_content.h
    explicit SurfaceSet(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

  private:
    std::shared_ptr<const Content> content_;
};

// A ray from a point of a surface that does not hit that surface again by rounding: starts a
// little off the surface on the side that the direction points to.
Ray leaving_ray(const SurfaceHit& hit, const Vec3d& direction);

}  // namespace gischt
