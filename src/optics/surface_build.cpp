// SPDX-License-Identifier: Apache-2.0
#include <cmath>

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
};

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
void set_lobe(SurfaceEntry& s, const Material& m) {
    const double alpha = m.roughness < least_roughness ? 0 : m.roughness * m.roughness;
    switch (m.kind) {
        case MaterialKind::Lambert:
            s.lobe = LambertLobe{};
            break;
        case MaterialKind::Conductor: {
            ConductorLobe lobe;
            lobe.alpha = alpha;
            lobe.is_color = !m.metal;
            if (m.metal) {
                const MetalIndex index = metal_index(*m.metal);
                lobe.eta = index.eta;
                lobe.k = index.k;
            }
            if (alpha > 0) s.energy = std::make_shared<EnergyTable>(alpha);
            lobe.energy = s.energy.get();
            s.lobe = lobe;
            break;
        }
        case MaterialKind::Dielectric: {
            if (alpha > 0) s.dielectric_energy = std::make_shared<DielectricEnergyTable>(alpha);
            s.lobe = DielectricLobe{m.ior, Vec3f(1), alpha, s.dielectric_energy.get()};
            break;
        }
        case MaterialKind::Plastic:
            s.energy = std::make_shared<EnergyTable>(alpha, m.ior);
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
            return Vec3f(m.albedo);
    }
}

// The homogeneous medium inside of a surface fills a box around it: only the surface bounds it.
std::shared_ptr<const Medium> inline_medium(const Shape& shape, const MediumParams& params,
                                            double time) {
    Region region;
    if (const auto* plane = std::get_if<Plane>(&shape)) {
        region.center = plane->point;
        region.size = Vec3d(2e6);
    } else {
        const Box3d box = bounds(shape);
        region = Region::box(box);
        region.size = 1.02 * region.size;
    }
    return std::make_shared<const Medium>(region, params, time);
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

SurfaceEntry make_surface(const SurfaceParams& surface, double time, double shutter,
                          const Vec3d& scene_up) {
    const Material& m = material_of(surface);
    SurfaceEntry s;
    s.params = surface;
    s.shape = shape_at(surface, time, scene_up);
    s.info.is_moving = shutter > 0 && std::visit(IsMoving{}, surface);
    if (s.info.is_moving) {
        // Sizes that are not positive are refused here, not in the middle of a picture.
        shape_at(surface, time - 0.5 * shutter, scene_up);
        shape_at(surface, time + 0.5 * shutter, scene_up);
    }
    s.to_board = local_frame(s.shape).inverse();
    s.albedo = base_color(m);
    s.checker = Vec3f(m.checker);
    s.checker_size = m.checker_size;
    set_lobe(s, m);

    SurfaceInfo& info = s.info;
    info.name = std::visit([](const auto& p) { return p.name; }, surface);
    info.material = m.kind;
    info.emission = Vec3f(m.emission.at(time));
    info.holdout = m.holdout;
    info.shadow_catcher = m.shadow_catcher;
    info.camera_visible = m.camera_visible;
    info.has_interior = m.kind == MaterialKind::Dielectric || m.kind == MaterialKind::None;
    info.priority = m.priority;
    if (m.kind == MaterialKind::Dielectric) info.ior = m.ior;
    if (info.has_interior && m.medium) info.medium = inline_medium(s.shape, *m.medium, time);
    if (const auto* sheet = sheet_of(surface)) {
        info.two_sided = sheet->two_sided;
        if (info.has_interior) refuse(info.name, "a sheet has no inside", "take a box");
    }
    s.is_stopping = m.kind != MaterialKind::None;
    return s;
}

}  // namespace gischt
