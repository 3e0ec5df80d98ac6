// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "optics/medium.h"
#include "optics/metal.h"
#include "optics/orientation.h"
#include "optics/surface_content.h"

namespace gischt {
namespace {

[[noreturn]] void refuse(const std::string& name, const char* what,
                         const char* hint = "give positive metres") {
    throw Error(ErrorKind::Usage, name.empty() ? "surface" : "surface '" + name + "'", what, hint);
}

Transform turned(const Vec3d& degrees) {
    return Transform::rotation({0, 0, 1}, radians(degrees.z)) *
           Transform::rotation({0, 1, 0}, radians(degrees.y)) *
           Transform::rotation({1, 0, 0}, radians(degrees.x));
}

struct ShapeAt {
    double time;
    Vec3d scene_up;

    Shape operator()(const SphereSurface& s) const {
        const Sphere sphere{s.center.at(time), s.radius.at(time)};
        if (!(sphere.radius > 0)) refuse(s.name, "the radius is not positive");
        return sphere;
    }
    Shape operator()(const BoxSurface& s) const {
        if (!(min_component(s.size) > 0)) refuse(s.name, "the size is not positive");
        return SolidBox{s.center.at(time), s.size, turned(s.rotation_degrees.at(time))};
    }
    Shape operator()(const GroundSurface& s) const {
        const Vec3d normal = s.normal ? *s.normal : scene_up;
        if (!(length(normal) > 0)) refuse(s.name, "the normal has no length");
        return Plane{s.point.at(time), normalize(normal)};
    }
    Shape operator()(const RectSurface& s) const {
        if (!(s.size.x > 0 && s.size.y > 0)) refuse(s.name, "the size is not positive");
        const Vec3d n = sheet_normal(s);
        // The first edge is horizontal; for a sheet that lies, along x.
        Vec3d x = cross(scene_up, n);
        x = length(x) > 1e-6 ? normalize(x) : up_frame(n).column[0];
        x = Transform::rotation(n, radians(s.roll_degrees)).vector(x);
        return Rectangle{s.center.at(time), s.size.x * x, s.size.y * cross(n, x)};
    }
    Shape operator()(const DiscSurface& s) const {
        if (!(s.radius > 0)) refuse(s.name, "the radius is not positive");
        return Disc{s.center.at(time), sheet_normal(s), s.radius};
    }
    Shape operator()(const MeshSurface& s) const {
        if (!(s.scale.at(time) > 0)) refuse(s.name, "the scale is not positive");
        return Sphere{};  // unused
    }
    Vec3d sheet_normal(const SheetPlace& s) const {
        const Vec3d n = s.target ? s.target->at(time) - s.center.at(time) : s.normal;
        if (!(length(n) > 0)) refuse(s.name, "the normal has no length");
        return normalize(n);
    }
};

struct IsMoving {
    bool operator()(const SphereSurface& s) const {
        return !s.center.is_constant() || !s.radius.is_constant();
    }
    bool operator()(const BoxSurface& s) const {
        return !s.center.is_constant() || !s.rotation_degrees.is_constant();
    }
    bool operator()(const GroundSurface& s) const { return !s.point.is_constant(); }
    bool operator()(const SheetPlace& s) const {
        return !s.center.is_constant() || (s.target && !s.target->is_constant());
    }
    bool operator()(const MeshSurface&) const { return false; }
};

bool moves(const MeshSurface& s, const Mesh& mesh) {
    return !mesh.velocities.empty() || !s.translate.is_constant() ||
           !s.rotate_degrees.is_constant() || !s.scale.is_constant();
}

struct LocalFrame {
    Transform operator()(const Sphere& s) const { return at({}, s.center); }
    // A corner is the origin, so that the fields of a checker board start at the edges.
    Transform operator()(const SolidBox& b) const {
        return at(b.rotation, b.center - b.rotation.vector(0.5 * b.size));
    }
    Transform operator()(const Plane& p) const { return at(up_frame(p.normal), p.point); }
    Transform operator()(const Rectangle& r) const {
        const Transform frame{{normalize(r.edge_x), normalize(r.edge_y), r.normal()}, {}};
        return at(frame, r.center - 0.5 * (r.edge_x + r.edge_y));
    }
    Transform operator()(const Disc& d) const { return at(up_frame(d.normal), d.center); }

    static Transform at(Transform frame, const Vec3d& origin) {
        frame.translation = origin;
        return frame;
    }
};

// Roughness below this counts as smooth: its lobe is narrower than the sun by far, and float has
// no room for its density.
constexpr double least_roughness = 0.01;

// The scattering function of a material without its albedo.
void set_lobe(SurfaceEntry& s, const Material& m, EnergyTables& tables) {
    const double alpha = m.roughness < least_roughness ? 0 : m.roughness * m.roughness;
    switch (m.kind) {
        case MaterialKind::Lambert:
            s.lobe = LambertLobe{};
            break;
        case MaterialKind::Conductor: {
            const MetalIndex index = m.metal ? metal_index(*m.metal) : MetalIndex{};
            if (alpha > 0) s.energy = tables.reflection(alpha, 0);
            s.lobe = ConductorLobe{index.eta, index.k, !m.metal, alpha, s.energy.get()};
            break;
        }
        case MaterialKind::Dielectric:
            if (alpha > 0) s.dielectric_energy = tables.dielectric(alpha);
            s.lobe = DielectricLobe{m.ior, Vec3f(1), alpha, s.dielectric_energy.get()};
            break;
        case MaterialKind::Plastic:
            s.energy = tables.reflection(alpha, m.ior);
            s.lobe = PlasticLobe{{}, m.ior, alpha, s.energy.get()};
            break;
        case MaterialKind::None:
            s.lobe = DielectricLobe{1, Vec3f(1), 0, nullptr};
            break;
    }
}

// The share that is reflected, or lets pass, by the material's kind.
Vec3f base_color(const Material& m) {
    switch (m.kind) {
        case MaterialKind::Conductor:
            return m.color ? Vec3f(*m.color) : Vec3f(m.metal ? 1.0f : 0.9f);
        case MaterialKind::Dielectric:
            return m.color ? Vec3f(*m.color) : Vec3f(1);
        default:
            return Vec3f(m.albedo.value_or(Vec3d(0.5)));
    }
}

// A homogeneous medium inside of a surface fills a box around it: only the surface bounds it.
std::shared_ptr<const Medium> inline_medium(const SurfaceEntry& s, const MediumParams& params,
                                            const SurfaceMoments& moments) {
    Region region;
    if (const auto* plane = std::get_if<Plane>(&s.shape)) {
        region.center = plane->point;
        region.size = Vec3d(2e6);
        return std::make_shared<const Medium>(region, params, moments.time);
    }
    Box3d box = Box3d::empty();
    if (s.mesh) {
        const TriangleObject object = triangle_object(s, moments);
        for (const Vec3d& p : object.points) box.extend(p);
        for (const Vec3d& p : object.points_end) box.extend(p);
    } else {
        for (const double moment : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            box.extend(bounds(shape_at(s.params, moments.at(moment), moments.scene_up)));
        }
    }
    region = Region::box(box);
    region.size = 1.1 * region.size;
    return std::make_shared<const Medium>(region, params, moments.time);
}

}  // namespace

Shape shape_at(const SurfaceParams& surface, double time, const Vec3d& scene_up) {
    return std::visit(ShapeAt{time, scene_up}, surface);
}

Transform local_frame(const Shape& shape) {
    return std::visit(LocalFrame{}, shape);
}

const Material& material_of(const SurfaceParams& surface) {
    return std::visit([](const auto& s) -> const Material& { return s.material; }, surface);
}

const SheetPlace* sheet_of(const SurfaceParams& surface) {
    if (const auto* rect = std::get_if<RectSurface>(&surface)) return rect;
    return std::get_if<DiscSurface>(&surface);
}

const std::string& surface_name(const SurfaceParams& surface) {
    return std::visit([](const auto& s) -> const std::string& { return s.name; }, surface);
}

std::shared_ptr<const EnergyTable> EnergyTables::reflection(double alpha, double eta) {
    auto& table = reflection_[{alpha, eta}];
    if (!table) table = std::make_shared<EnergyTable>(alpha, eta);
    return table;
}

std::shared_ptr<const DielectricEnergyTable> EnergyTables::dielectric(double alpha) {
    auto& table = dielectric_[alpha];
    if (!table) table = std::make_shared<DielectricEnergyTable>(alpha);
    return table;
}

Transform mesh_placement(const MeshSurface& mesh, double time, const Vec3d& scene_up) {
    const Vec3d file_up = mesh.up == FileUp::Y ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    Transform t = turned(mesh.rotate_degrees.at(time)) *
                  Transform::scale_translate(mesh.scale.at(time), {}) * up_frame(scene_up) *
                  up_frame(file_up).inverse();
    t.translation = mesh.translate.at(time);
    return t;
}

TriangleObject triangle_object(const SurfaceEntry& s, const SurfaceMoments& moments) {
    const auto& params = std::get<MeshSurface>(s.params);
    const Mesh& mesh = *s.mesh->source;
    const auto points_at = [&](double moment) {
        const Transform map = mesh_placement(params, moments.at(moment), moments.scene_up);
        std::vector<Vec3d> points;
        points.reserve(mesh.points.size());
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            Vec3d p(mesh.points[i]);
            if (!mesh.velocities.empty()) {
                p += (moment - 0.5) * moments.shutter * Vec3d(mesh.velocities[i]);
            }
            points.push_back(map.point(p));
        }
        return points;
    };
    TriangleObject object;
    object.points = points_at(s.info.is_moving ? 0 : 0.5);
    if (s.info.is_moving) object.points_end = points_at(1);
    object.triangles = mesh.triangles;
    object.bits = (s.info.camera_visible ? 0 : skips_camera) | (s.is_stopping ? 0 : skips_shadow);
    return object;
}

// What a surface is beside its shape.
static SurfaceInfo make_info(const SurfaceParams& surface, const Material& m, double time) {
    SurfaceInfo info;
    info.name = surface_name(surface);
    info.material = m.kind;
    info.emission = Vec3f(m.emission.at(time));
    info.holdout = m.holdout;
    info.shadow_catcher = m.shadow_catcher;
    info.camera_visible = m.camera_visible;
    info.has_interior = m.kind == MaterialKind::Dielectric || m.kind == MaterialKind::None;
    info.priority = m.priority;
    if (m.kind == MaterialKind::Dielectric) info.ior = m.ior;
    if (const SheetPlace* sheet = sheet_of(surface)) {
        info.two_sided = sheet->two_sided;
        info.is_sheet = true;
        if (info.has_interior) refuse(info.name, "a sheet has no inside", "take a box");
    }
    return info;
}

// A mesh where it stands in the middle of the shutter.
static void place_mesh(SurfaceEntry& s, const SurfaceSources& sources,
                       const SurfaceMoments& moments) {
    const auto& params = std::get<MeshSurface>(s.params);
    if (!sources.mesh) refuse(s.info.name, "meshes cannot be read here", "take another shape");
    auto mesh = std::make_shared<PlacedMesh>();
    mesh->source = sources.mesh;
    mesh->is_closed = sources.is_closed;
    const Transform map = mesh_placement(params, moments.time, moments.scene_up);
    s.to_board = map.inverse();
    for (const Vec3f& n : sources.mesh->normals) {
        mesh->normals.emplace_back(normalize(map.vector(Vec3d(n))));
    }
    s.info.is_moving = moments.shutter > 0 && moves(params, *sources.mesh);
    // A closed one shines outwards, as half of the samples would be lost inside.
    s.info.two_sided = !sources.is_closed;
    s.info.is_sheet = !sources.is_closed;
    s.mesh = std::move(mesh);
}

SurfaceEntry make_surface(const SurfaceParams& surface, const SurfaceSources& sources,
                          const SurfaceMoments& moments, EnergyTables& tables) {
    const Material& m = material_of(surface);
    SurfaceEntry s;
    s.params = surface;
    s.info = make_info(surface, m, moments.time);
    s.is_stopping = m.kind != MaterialKind::None;
    s.shape = shape_at(surface, moments.time, moments.scene_up);
    // Sizes that are not positive are refused here, not in the middle of a picture.
    for (const double moment : {0.0, 1.0}) {
        shape_at(surface, moments.at(moment), moments.scene_up);
    }
    if (std::holds_alternative<MeshSurface>(surface)) {
        place_mesh(s, sources, moments);
    } else {
        s.info.is_moving = moments.shutter > 0 && std::visit(IsMoving{}, surface);
        s.to_board = local_frame(s.shape).inverse();
    }
    s.albedo = base_color(m);
    s.checker = Vec3f(m.checker);
    s.checker_size = m.checker_size;
    if (m.texture && !sources.texture) {
        refuse(s.info.name, "pictures cannot be read here", "give one colour");
    }
    if (m.texture) s.repeat = m.texture->repeat;
    s.texture = sources.texture;
    set_lobe(s, m, tables);
    if (s.info.has_interior) {
        s.info.medium = m.medium ? inline_medium(s, *m.medium, moments) : sources.medium;
    }
    return s;
}

void finish(SurfaceSet::Content& content, const EmbreeScene* meshes) {
    const SurfaceMoments moments{content.time, content.shutter, content.scene_up};
    std::vector<TriangleObject> objects;
    for (std::size_t i = 0; i < content.surfaces.size(); ++i) {
        SurfaceEntry& s = content.surfaces[i];
        if (!s.mesh) {
            content.analytic.push_back(static_cast<int>(i));
            continue;
        }
        s.object = static_cast<int>(content.mesh_surfaces.size());
        content.mesh_surfaces.push_back(static_cast<int>(i));
        if (!meshes) objects.push_back(triangle_object(s, moments));
    }
    content.meshes = meshes ? *meshes : EmbreeScene(std::move(objects));
    content.lights = make_surface_lights(content);
    for (std::size_t i = 0; i < content.lights.size(); ++i) {
        const auto surface = static_cast<std::size_t>(content.lights[i]->surface());
        content.surfaces[surface].light = static_cast<int>(i);
    }
}

}  // namespace gischt
