// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    moved = shape_at(s.params, time_at(moment), scene_up);
    return moved;
}

SurfaceSet::SurfaceSet(const std::vector<SurfaceParams>& surfaces, double time,
                       const Vec3d& scene_up, double shutter) {
    if (surfaces.empty()) return;
    auto content = std::make_shared<Content>();
    content->time = time;
    content->shutter = shutter;
    content->scene_up = scene_up;
    for (const SurfaceParams& s : surfaces) {
        content->surfaces.push_back(make_surface(s, time, shutter, scene_up));
    }
    content->lights = make_surface_lights(content->surfaces);
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

bool SurfaceSet::is_interior(const Medium* medium) const {
    if (!content_ || !medium) return false;
    return std::any_of(content_->surfaces.begin(), content_->surfaces.end(),
                       [&](const SurfaceEntry& s) { return s.info.medium.get() == medium; });
}

std::optional<SurfaceHit> SurfaceSet::intersect(const Ray& ray, float moment, RayKind kind) const {
    if (!content_) return std::nullopt;
    Ray rest = ray;
    std::optional<Hit> nearest;
    std::size_t index = 0;
    Shape moved;
    for (std::size_t i = 0; i < content_->surfaces.size(); ++i) {
        const SurfaceEntry& s = content_->surfaces[i];
        if (kind == RayKind::Camera && !s.info.camera_visible) continue;
        if (const auto h = gischt::intersect(content_->shape(s, moment, moved), rest)) {
            nearest = h;
            rest.t_max = h->t;
            index = i;
        }
    }
    if (!nearest) return std::nullopt;
    const SurfaceEntry& s = content_->surfaces[index];
    const Shape& shape = content_->shape(s, moment, moved);
    SurfaceHit hit;
    hit.t = nearest->t;
    hit.point = ray.at(hit.t);
    hit.front = dot(nearest->normal, ray.direction) <= 0;
    hit.normal = hit.front ? nearest->normal : -nearest->normal;
    hit.shading_normal = hit.normal;
    hit.offset = rounding_offset(shape, ray, hit.t);
    hit.surface = static_cast<int>(index);
    const Transform to_board = s.info.is_moving ? local_frame(shape).inverse() : s.to_board;
    const Vec3d p = to_board.point(hit.point), n = to_board.vector(nearest->normal);
    hit.uv = std::visit(Coordinates{p, n}, shape);
    const bool second = s.checker_size > 0 && is_second_field(s, p, n);
    hit.albedo = second ? s.checker : s.albedo;
    if (hit.front || s.info.two_sided) hit.emission = s.info.emission;
    hit.primitive = nearest->face;
    return hit;
}

bool SurfaceSet::is_blocked(const Ray& ray, float moment) const {
    if (!content_) return false;
    Shape moved;
    for (const SurfaceEntry& s : content_->surfaces) {
        if (s.is_stopping && gischt::intersect(content_->shape(s, moment, moved), ray)) return true;
    }
    return false;
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
    for (int i = 0; i < size(); ++i) {
        const SurfaceEntry& s = content_->surfaces[static_cast<std::size_t>(i)];
        if (!s.info.has_interior) continue;
        const Shape& shape = content_->shape(s, moment, moved);
        if (signed_distance(shape, point) >= 0) continue;
        const auto exit = gischt::intersect(shape, ray);
        insides.push_back({exit ? exit->t : std::numeric_limits<double>::infinity(), i});
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
    for (const SurfaceEntry& s : content_->surfaces) {
        if (!std::holds_alternative<Plane>(s.shape)) all.extend(gischt::bounds(s.shape));
    }
    return all;
}

Ray leaving_ray(const SurfaceHit& hit, const Vec3d& direction) {
    Ray ray;
    const double side = dot(direction, hit.normal) < 0 ? -1 : 1;
    ray.origin = hit.point + side * hit.offset * hit.normal;
    ray.direction = direction;
    return ray;
}

}  // namespace gischt
