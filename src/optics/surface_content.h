// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "optics/ggx_energy.h"
#include "optics/surface.h"
#include "optics/surface_light.h"
#include "optics/surface_params.h"
#include "optics/texture.h"
#include "shape/embree_scene.h"
#include "shape/mesh.h"
#include "shape/shape.h"

namespace gischt {

// What a SurfaceSet holds; for the files that build and query it.

// A mesh where it stands at the middle of the shutter.
struct PlacedMesh {
    std::shared_ptr<const Mesh> source;  // for triangles and coordinates
    std::vector<Vec3f> normals;          // per point, in the scene's frame; may be empty
    bool is_closed = false;
};

// A surface at the moments of a shutter.
struct SurfaceEntry {
    SurfaceParams params;
    SurfaceInfo info;
    Shape shape;                             // at the middle of the shutter; not for a mesh
    std::shared_ptr<const PlacedMesh> mesh;  // null for analytic shapes
    int object = -1;                         // of a mesh in the search tree
    int light = -1;                          // among the lights
    bool is_stopping = true;                 // blocks light: all but material None
    Transform to_board;  // a point into the frame of checker board and coordinates

    Vec3f albedo, checker;
    double checker_size = 0;
    std::shared_ptr<const Texture> texture;
    Vec2d repeat{1, 1};
    // The scattering with the albedo yet to be put in.
    BsdfLobe lobe;
    std::shared_ptr<const EnergyTable> energy;
    std::shared_ptr<const DielectricEnergyTable> dielectric_energy;
};

// Bits of the objects of the search tree, that rays pass.
inline constexpr std::uint32_t skips_camera = 1, skips_shadow = 2;

struct SurfaceSet::Content {
    std::vector<SurfaceEntry> surfaces;
    std::vector<int> analytic;       // the surfaces that are no mesh
    EmbreeScene meshes;              // all others
    std::vector<int> mesh_surfaces;  // by object of the search tree
    std::vector<std::shared_ptr<const SurfaceLight>> lights;
    double time = 0, shutter = 0;
    Vec3d scene_up;

    // The shape of an analytic surface; `moved` is where it is put when it moves.
    const Shape& shape(const SurfaceEntry& s, float moment, Shape& moved) const;
};

// What lies outside of the parameters of a surface, loaded before.
struct SurfaceSources {
    std::shared_ptr<const Mesh> mesh;  // in the frame of its file
    bool is_closed = false;            // the mesh
    std::shared_ptr<const Texture> texture;
    std::shared_ptr<const Medium> medium;  // what `interior` names
};

// The tables of rough materials, made once.
class EnergyTables {
  public:
    std::shared_ptr<const EnergyTable> reflection(double alpha, double eta);
    std::shared_ptr<const DielectricEnergyTable> dielectric(double alpha);

  private:
    std::map<std::pair<double, double>, std::shared_ptr<const EnergyTable>> reflection_;
    std::map<double, std::shared_ptr<const DielectricEnergyTable>> dielectric_;
};

// The moments for which surfaces are made.
struct SurfaceMoments {
    double time = 0, shutter = 0;
    Vec3d scene_up;

    double at(double moment) const { return time + (moment - 0.5) * shutter; }
};

// Throws Error{Usage} on a size that is not positive.
Shape shape_at(const SurfaceParams& surface, double time, const Vec3d& scene_up);
SurfaceEntry make_surface(const SurfaceParams& surface, const SurfaceSources& sources,
                          const SurfaceMoments& moments, EnergyTables& tables);
// Completes a content whose `surfaces` are made. `meshes` is the search tree if it is known.
void finish(SurfaceSet::Content& content, const EmbreeScene* meshes);

// From the file's frame to the scene.
Transform mesh_placement(const MeshSurface& mesh, double time, const Vec3d& scene_up);
// A mesh for the search tree, in the scene's frame.
TriangleObject triangle_object(const SurfaceEntry& s, const SurfaceMoments& moments);

// The local frame of a shape: a sphere's centre, a box's corner, a plane's point with its normal
// along z.
Transform local_frame(const Shape& shape);

const Material& material_of(const SurfaceParams& surface);
const std::string& surface_name(const SurfaceParams& surface);
// Null when it is no sheet.
const SheetPlace* sheet_of(const SurfaceParams& surface);

}  // namespace gischt
