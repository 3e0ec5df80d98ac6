// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "optics/surface_content.h"
#include "optics/surface_light.h"

namespace gischt {
namespace {

// Whether a point of the surface, in the frame of the board, lies on a field of the second colour.
// The axis along the normal does not count, so that rounding across a face cannot flicker.
bool is_second_field(const SurfaceEntry& s, const Vec3d& p, const Vec3d& n) {
    const bool is_flat = !std::holds_alternative<Sphere>(s.shape);
    long fields = 0;
    for (int a = 0; a < 3; ++a) {
        if (is_flat && std::abs(n[a]) > 0.999) continue;
        fields += std::lround(std::floor(p[a] / s.checker_size));
    }
    return (fields & 1) != 0;
}

// Coordinates of a point on a shape, both in the shape's frame.
struct Coordinates {
    Vec3d p, n;

    Vec2d operator()(const Sphere&) const {
        return {0.5 + std::atan2(n.y, n.x) / (2 * pi),
                0.5 + std::asin(std::clamp(n.z, -1.0, 1.0)) / pi};
    }
    Vec2d operator()(const SolidBox& b) const {
        const int axis = largest_axis(), u = (axis + 1) % 3, v = (axis + 2) % 3;
        return {p[u] / b.size[u], p[v] / b.size[v]};
    }
    Vec2d operator()(const Plane&) const { return {p.x, p.y}; }
    Vec2d operator()(const Rectangle& r) const {
        return {p.x / length(r.edge_x), p.y / length(r.edge_y)};
    }
    Vec2d operator()(const Disc& d) const {
        return {0.5 + 0.5 * p.x / d.radius, 0.5 + 0.5 * p.y / d.radius};
    }

    int largest_axis() const {
        const Vec3d a = abs(n);
        return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    }
};

// How far rounding in double puts a point off its surface, with room for the next ray's arithmetic:
// some 30 operations of half an ulp each on numbers of this size (Ize 2013, "Robust BVH ray
// traversal"; Waechter & Binder 2019, "A fast and robust method for avoiding self-intersection").
double rounding_offset(const Shape& shape, const Ray& ray, double t) {
    struct Size {
        double operator()(const Sphere& s) const { return max_component(abs(s.center)) + s.radius; }
        double operator()(const SolidBox& b) const {
            return max_component(abs(b.center)) + max_component(b.size);
        }
        double operator()(const Plane& p) const { return max_component(abs(p.point)); }
        double operator()(const Rectangle& r) const { return max_component(abs(r.center)); }
        double operator()(const Disc& d) const { return max_component(abs(d.center)); }
    };
    constexpr double ulps = 32 * std::numeric_limits<double>::epsilon();
    const double way = max_component(abs(ray.origin)) + t * max_component(abs(ray.direction));
    return ulps * (way + std::visit(Size{}, shape)) + std::numeric_limits<double>::min();
}

}  // namespace

const Shape& SurfaceSet::Content::shape(const SurfaceEntry& s, float moment, Shape& moved) const {
    if (!s.info.is_moving) return s.shape;
    const SurfaceMoments moments{time, shutter, scene_up};
    moved = shape_at(s.params, moments.at(static_cast<double>(moment)), scene_up);
    return moved;
}

SurfaceSet::SurfaceSet(const std::vector<SurfaceParams>& surfaces, double time,
                       const Vec3d& scene_up, double shutter) {
    if (surfaces.empty()) return;
    auto content = std::make_shared<Content>();
    content->time = time;
    content->shutter = shutter;
    content->scene_up = scene_up;
    EnergyTables tables;
    for (const SurfaceParams& s : surfaces) {
        if (!material_of(s).interior.empty()) {
            throw Error(ErrorKind::Usage, surface_name(s), "fluids are not known here");
        }
        content->surfaces.push_back(make_surface(s, {}, {time, shutter, scene_up}, tables));
    }
    finish(*content, nullptr);
    content_ = std::move(content);
}

const std::vector<std::shared_ptr<const SurfaceLight>>& SurfaceSet::lights() const {
    static const std::vector<std::shared_ptr<const SurfaceLight>> none;
    return content_ ? content_->lights : none;
}

int SurfaceSet::size() const {
    return content_ ? static_cast<int>(content_->surfaces.size()) : 0;
}

const SurfaceInfo& SurfaceSet::info(int surface) const {
    return content_->surfaces[static_cast<std::size_t>(surface)].info;
}

int SurfaceSet::light_of(int surface) const {
    return content_->surfaces[static_cast<std::size_t>(surface)].light;
}

bool SurfaceSet::is_interior(const Medium* medium) const {
    if (!content_ || !medium) return false;
    return std::any_of(content_->surfaces.begin(), content_->surfaces.end(),
                       [&](const SurfaceEntry& s) { return s.info.medium.get() == medium; });
}

namespace {

// Albedo, emission and side of a hit whose place is known; `outward` is the outer normal.
void finish_hit(SurfaceHit& hit, const SurfaceEntry& s, const Transform& to_board,
                const Vec3d& outward) {
    const bool is_board = s.checker_size > 0;
    const bool second =
        is_board && is_second_field(s, to_board.point(hit.point), to_board.vector(outward));
    hit.albedo = second ? s.checker : s.albedo;
    if (s.texture)
        hit.albedo = hit.albedo * s.texture->at({s.repeat.x * hit.uv.x, s.repeat.y * hit.uv.y});
    if (hit.front || s.info.two_sided) hit.emission = s.info.emission;
}

SurfaceHit analytic_hit(const SurfaceEntry& s, const Shape& shape, const Hit& found,
                        const Ray& ray) {
    SurfaceHit hit;
    hit.t = found.t;
    hit.point = ray.at(hit.t);
    hit.front = dot(found.normal, ray.direction) <= 0;
    hit.normal = hit.front ? found.normal : -found.normal;
    hit.shading_normal = hit.normal;
    hit.offset = rounding_offset(shape, ray, hit.t);
    hit.primitive = found.face;
    const Transform to_board = s.info.is_moving ? local_frame(shape).inverse() : s.to_board;
    hit.uv =
        std::visit(Coordinates{to_board.point(hit.point), to_board.vector(found.normal)}, shape);
    finish_hit(hit, s, to_board, found.normal);
    return hit;
}

SurfaceHit mesh_hit(const SurfaceEntry& s, const TriangleHit& found, const Ray& ray) {
    SurfaceHit hit;
    hit.t = found.t;
    hit.point = found.point;
    hit.front = dot(found.normal, ray.direction) <= 0;
    hit.normal = hit.front ? found.normal : -found.normal;
    hit.offset = found.offset;
    hit.primitive = found.triangle;
    const Mesh& mesh = *s.mesh->source;
    const Vec3i& t = mesh.triangles[static_cast<std::size_t>(found.triangle)];
    const auto i = static_cast<std::size_t>(t.x), j = static_cast<std::size_t>(t.y),
               k = static_cast<std::size_t>(t.z);
    const double b = found.barycentric.x, c = found.barycentric.y, a = 1 - b - c;
    const Vec3d out = -normalize(ray.direction);
    hit.shading_normal = hit.normal;
    if (!s.mesh->normals.empty() && dot(out, hit.normal) > 0) {
        const auto& n = s.mesh->normals;
        Vec3d smooth = a * Vec3d(n[i]) + b * Vec3d(n[j]) + c * Vec3d(n[k]);
        if (!hit.front) smooth = -smooth;
        const double l = length(smooth);
        if (l > 1e-6) hit.shading_normal = valid_shading_normal(smooth / l, hit.normal, out);
    }
    hit.uv = found.barycentric;
    if (!mesh.uvs.empty()) {
        const auto mix = [&](float p, float q, float r) {
            return a * static_cast<double>(p) + b * static_cast<double>(q) +
                   c * static_cast<double>(r);
        };
        const Vec2f &p = mesh.uvs[i], q = mesh.uvs[j], r = mesh.uvs[k];
        hit.uv = {mix(p.x, q.x, r.x), mix(p.y, q.y, r.y)};
    }
    finish_hit(hit, s, s.to_board, found.normal);
    return hit;
}

}  // namespace

std::optional<SurfaceHit> SurfaceSet::intersect(const Ray& ray, float moment, RayKind kind) const {
    if (!content_) return std::nullopt;
    const Content& c = *content_;
    Ray rest = ray;
    std::optional<Hit> nearest;
    int index = 0;
    Shape moved;
    for (const int i : c.analytic) {
        const SurfaceEntry& s = c.surfaces[static_cast<std::size_t>(i)];
        if (kind == RayKind::Camera && !s.info.camera_visible) continue;
        if (const auto h = gischt::intersect(c.shape(s, moment, moved), rest)) {
            nearest = h;
            rest.t_max = h->t;
            index = i;
        }
    }
    const auto triangle =
        c.meshes.intersect(rest, moment, kind == RayKind::Camera ? skips_camera : 0);
    SurfaceHit hit;
    if (triangle && (!nearest || triangle->t <= nearest->t)) {
        index = c.mesh_surfaces[static_cast<std::size_t>(triangle->object)];
        hit = mesh_hit(c.surfaces[static_cast<std::size_t>(index)], *triangle, ray);
    } else if (nearest) {
        const SurfaceEntry& s = c.surfaces[static_cast<std::size_t>(index)];
        hit = analytic_hit(s, c.shape(s, moment, moved), *nearest, ray);
    } else {
        return std::nullopt;
    }
    hit.surface = index;
    return hit;
}

bool SurfaceSet::is_blocked(const Ray& ray, float moment) const {
    if (!content_) return false;
    Shape moved;
    for (const int i : content_->analytic) {
        const SurfaceEntry& s = content_->surfaces[static_cast<std::size_t>(i)];
        if (s.is_stopping && gischt::intersect(content_->shape(s, moment, moved), ray)) return true;
    }
    return content_->meshes.is_blocked(ray, moment, skips_shadow);
}

Bsdf SurfaceSet::bsdf(const SurfaceHit& hit, double relative_ior) const {
    struct Fill {
        const SurfaceHit& hit;
        double relative_ior;

        void operator()(LambertLobe& l) const { l.albedo = hit.albedo; }
        void operator()(PlasticLobe& l) const { l.albedo = hit.albedo; }
        void operator()(ConductorLobe& l) const {
            if (l.is_color) l.eta = hit.albedo;
        }
        void operator()(DielectricLobe& l) const {
            l.tint = hit.albedo;
            if (l.eta == 1) return;  // material None
            l.eta = relative_ior > 0 ? relative_ior : hit.front ? l.eta : 1 / l.eta;
        }
    };
    const SurfaceEntry& s = content_->surfaces[static_cast<std::size_t>(hit.surface)];
    BsdfLobe lobe = s.lobe;
    std::visit(Fill{hit, relative_ior}, lobe);
    return {hit.normal, hit.shading_normal, lobe};
}

std::vector<int> SurfaceSet::interiors_at(const Vec3d& point, float moment) const {
    if (!content_) return {};
    struct Inside {
        double exit;
        int surface;
    };
    // No axis of the scene, so that edges of boxes are not met.
    Ray ray;
    ray.origin = point;
    ray.direction = normalize(Vec3d{0.3190, 0.5241, 0.7897});
    std::vector<Inside> insides;
    Shape moved;
    for (const int i : content_->analytic) {
        const SurfaceEntry& s = content_->surfaces[static_cast<std::size_t>(i)];
        if (!s.info.has_interior) continue;
        const Shape& shape = content_->shape(s, moment, moved);
        if (signed_distance(shape, point) >= 0) continue;
        const auto exit = gischt::intersect(shape, ray);
        insides.push_back({exit ? exit->t : std::numeric_limits<double>::infinity(), i});
    }
    // A ray out of a closed mesh leaves it as often more than it enters as it starts inside; each
    // new record of that number is the exit from one more layer.
    std::vector<int> left(content_->mesh_surfaces.size(), 0), record = left;
    for (const TriangleHit& h : content_->meshes.all_hits(ray, moment)) {
        const auto object = static_cast<std::size_t>(h.object);
        const int surface = content_->mesh_surfaces[object];
        if (!info(surface).has_interior) continue;
        left[object] += dot(h.normal, ray.direction) > 0 ? 1 : -1;
        if (left[object] <= record[object]) continue;
        record[object] = left[object];
        insides.push_back({h.t, surface});
    }
    std::stable_sort(insides.begin(), insides.end(),
                     [](const Inside& a, const Inside& b) { return a.exit > b.exit; });
    std::vector<int> surfaces;
    for (const Inside& i : insides) surfaces.push_back(i.surface);
    return surfaces;
}

Box3d SurfaceSet::bounds() const {
    Box3d all = Box3d::empty();
    if (!content_) return all;
    for (const int i : content_->analytic) {
        const Shape& shape = content_->surfaces[static_cast<std::size_t>(i)].shape;
        if (!std::holds_alternative<Plane>(shape)) all.extend(gischt::bounds(shape));
    }
    if (!content_->meshes.is_empty()) all.extend(content_->meshes.bounds());
    return all;
}

Box3d SurfaceSet::bounds_of(int surface) const {
    const SurfaceEntry& s = content_->surfaces[static_cast<std::size_t>(surface)];
    return s.mesh ? content_->meshes.bounds() : gischt::bounds(s.shape);
}

Ray leaving_ray(const SurfaceHit& hit, const Vec3d& direction) {
    Ray ray;
    const double side = dot(direction, hit.normal) < 0 ? -1 : 1;
    ray.origin = hit.point + side * hit.offset * hit.normal;
    ray.direction = direction;
    return ray;
}

}  // namespace gischt
