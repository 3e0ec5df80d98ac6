// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_rig.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "optics/area_lights.h"
#include "optics/surface_content.h"

namespace gischt {
namespace {

// Where all meshes stand at the ends of the shutter: the search tree belongs to it.
using Placements = std::vector<std::pair<Transform, Transform>>;

std::string title(const SurfaceParams& s) {
    return surface_name(s).empty() ? "solid" : "solid '" + surface_name(s) + "'";
}

void report(const SurfaceParams& params, const MeshFaults& faults, bool is_closed, double volume,
            Job& job) {
    const std::string name = title(params);
    if (faults.sum() > 0) {
        job.warn(
            fmt::format("{}: {} triangles dropped: {} without area, {} with points that are "
                        "not finite, {} with points that do not exist",
                        name, faults.sum(), faults.flat, faults.not_finite, faults.no_point));
    }
    const MaterialKind kind = material_of(params).kind;
    if (kind != MaterialKind::Dielectric && kind != MaterialKind::None) return;
    if (!is_closed) {
        job.warn(name +
                 ": the mesh is not closed; light that refracts at it does not know inside "
                 "from outside everywhere");
    } else if (volume < 0) {
        job.warn(name + ": the mesh is turned inside out: its inside is what lies around it");
    }
}

// The colour of a file, where the scene gives none.
void take_color(SurfaceParams& solid, const SurfaceRig::ColoredMesh& loaded) {
    Material& m = std::get<MeshSurface>(solid).material;
    const bool takes = m.kind == MaterialKind::Lambert || m.kind == MaterialKind::Plastic;
    if (!takes || m.albedo || m.texture) return;
    if (loaded.color) m.albedo = Vec3d(*loaded.color);
    if (loaded.picture.empty()) return;
    if (!m.albedo) m.albedo = Vec3d(1);
    m.texture = TextureParams{.file = loaded.picture};
}

}  // namespace

struct SurfaceRig::Loaded {
    struct Solid {
        SurfaceParams params;
        SurfaceSources sources;
    };
    std::vector<Solid> solids;
    std::vector<AnyLightParams> lights;
    Vec3d scene_up;
    std::map<std::string, std::shared_ptr<const Texture>> textures;
    EnergyTables tables;
    Placements placements;
    EmbreeScene meshes;

    void load(Solid& solid, const MeshLoader& load_mesh, const ImageLoader& load_image, Job& job);
    const EmbreeScene* known_meshes(double time, double shutter);
};

void SurfaceRig::Loaded::load(Solid& solid, const MeshLoader& load_mesh,
                              const ImageLoader& load_image, Job& job) {
    if (const auto* params = std::get_if<MeshSurface>(&solid.params)) {
        if (!load_mesh) {
            throw Error(ErrorKind::Usage, title(solid.params), "meshes cannot be read here");
        }
        ColoredMesh loaded = load_mesh(params->file, job);
        Mesh& mesh = loaded.mesh;
        const MeshFaults faults = remove_faults(mesh);
        if (mesh.triangles.empty()) {
            throw Error(ErrorKind::Input, params->file, "has no triangle with an area");
        }
        solid.sources.is_closed = is_closed(mesh);
        report(solid.params, faults, solid.sources.is_closed, enclosed_volume(mesh), job);
        if (params->smooth_degrees) {
            if (*params->smooth_degrees > 0) {
                mesh = with_smooth_normals(mesh, *params->smooth_degrees);
            } else {
                mesh.normals.clear();
            }
        }
        solid.sources.mesh = std::make_shared<const Mesh>(std::move(mesh));
        take_color(solid.params, loaded);
    }
    if (const auto& texture = material_of(solid.params).texture) {
        if (!load_image) {
            throw Error(ErrorKind::Usage, title(solid.params), "pictures cannot be read here");
        }
        auto& known = textures[texture->file];
        if (!known) known = std::make_shared<const Texture>(load_image(texture->file));
        solid.sources.texture = known;
    }
}

SurfaceRig::SurfaceRig() = default;
SurfaceRig::~SurfaceRig() = default;
SurfaceRig::SurfaceRig(SurfaceRig&&) noexcept = default;
SurfaceRig& SurfaceRig::operator=(SurfaceRig&&) noexcept = default;

SurfaceRig::SurfaceRig(const std::vector<SurfaceParams>& solids,
                       const std::vector<AnyLightParams>& lights, const Vec3d& scene_up,
                       const MeshLoader& load_mesh, const ImageLoader& load_image, Job& job)
    : loaded_(std::make_unique<Loaded>()) {
    loaded_->lights = lights;
    loaded_->scene_up = scene_up;
    for (const SurfaceParams& params : solids) {
        Loaded::Solid& solid = loaded_->solids.emplace_back();
        solid.params = params;
        loaded_->load(solid, load_mesh, load_image, job);
    }
}

// The search tree of the frame before, where no mesh has moved since.
const EmbreeScene* SurfaceRig::Loaded::known_meshes(double time, double shutter) {
    const SurfaceMoments moments{time, shutter, scene_up};
    Placements now;
    for (const Solid& s : solids) {
        const auto* mesh = std::get_if<MeshSurface>(&s.params);
        if (!mesh) continue;
        // Points that move by themselves are elsewhere with each shutter.
        if (!s.sources.mesh->velocities.empty()) return nullptr;
        now.emplace_back(mesh_placement(*mesh, moments.at(0), scene_up),
                         mesh_placement(*mesh, moments.at(1), scene_up));
    }
    const bool is_known = !meshes.is_empty() && now == placements;
    placements = std::move(now);
    return is_known ? &meshes : nullptr;
}

SurfaceSet SurfaceRig::at(double time, double shutter, const Media& media) {
    if (!loaded_) return {};
    const SurfaceMoments moments{time, shutter, loaded_->scene_up};
    auto content = std::make_shared<SurfaceSet::Content>();
    content->time = time;
    content->shutter = shutter;
    content->scene_up = loaded_->scene_up;
    for (Loaded::Solid& solid : loaded_->solids) {
        const std::string& interior = material_of(solid.params).interior;
        solid.sources.medium = nullptr;
        if (!interior.empty()) {
            const auto found = media.find(interior);
            if (found == media.end()) {
                std::vector<std::string> names;
                for (const auto& m : media) names.push_back(m.first);
                throw Error(ErrorKind::Usage, title(solid.params),
                            "there is no fluid '" + interior + "' to fill it",
                            hint_for(interior, names));
            }
            solid.sources.medium = found->second;
        }
        content->surfaces.push_back(
            make_surface(solid.params, solid.sources, moments, loaded_->tables));
    }
    for (const AnyLightParams& light : loaded_->lights) {
        const auto surface = lamp_surface(light, time);
        if (!surface) continue;
        content->surfaces.push_back(make_surface(*surface, {}, moments, loaded_->tables));
        content->surfaces.back().info.is_lamp = true;
    }
    if (content->surfaces.empty()) return {};
    finish(*content, loaded_->known_meshes(time, shutter));
    loaded_->meshes = content->meshes;
    return SurfaceSet(std::move(content));
}

}  // namespace gischt
