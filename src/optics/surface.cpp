// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "optics/orientation.h"
#include "shape/shape.h"

namespace gischt {
namespace {

struct Surface {
    Shape shape;
    Vec3f albedo, checker, emission;
    double checker_size;
    // Turns a point into the frame of the checker board.
    Transform to_board;
};

[[noreturn]] void refuse(const std::string& name, const char* what) {
    throw Error(ErrorKind::Usage, name.empty() ? "surface" : "surface '" + name + "'", what,
                "give positive metres");
}

Transform turned(const Vec3d& degrees) {
    return Transform::rotation({0, 0, 1}, radians(degrees.z)) *
           Transform::rotation({0, 1, 0}, radians(degrees.y)) *
           Transform::rotation({1, 0, 0}, radians(degrees.x));
}

// Moves the origin of `frame` to `point` and inverts: world to local.
Transform to_local(Transform frame, const Vec3d& point) {
    frame.translation = point;
    return frame.inverse();
}

struct AtTime {
    double time;
    Vec3d scene_up;

    Surface with_material(Shape shape, const Material& m, const Transform& to_board) const {
        return {std::move(shape),           Vec3f(m.albedo), Vec3f(m.checker),
                Vec3f(m.emission.at(time)), m.checker_size,  to_board};
    }
    Surface operator()(const SphereSurface& s) const {
        const Sphere sphere{s.center.at(time), s.radius.at(time)};
        if (!(sphere.radius > 0)) refuse(s.name, "the radius is not positive");
        return with_material(sphere, s.material, to_local({}, sphere.center));
    }
    Surface operator()(const BoxSurface& s) const {
        if (!(min_component(s.size) > 0)) refuse(s.name, "the size is not positive");
        const SolidBox box{s.center.at(time), s.size, turned(s.rotation_degrees.at(time))};
        // A corner is the origin, so that the fields start at the edges.
        Transform frame = box.rotation;
        frame.translation = box.center - box.rotation.vector(0.5 * box.size);
        return with_material(box, s.material, frame.inverse());
    }
    Surface operator()(const GroundSurface& s) const {
        const Vec3d normal = s.normal ? *s.normal : scene_up;
        if (!(length(normal) > 0)) refuse(s.name, "the normal has no length");
        const Plane plane{s.point.at(time), normalize(normal)};
        return with_material(plane, s.material, to_local(up_frame(plane.normal), plane.point));
    }
};

// Whether a point of the surface lies on a field of the second colour. The axis along the normal
// does not count, so that rounding across a face cannot flicker.
bool is_second_field(const Surface& s, const Vec3d& point, const Vec3d& normal) {
    const Vec3d p = s.to_board.point(point), n = abs(s.to_board.vector(normal));
    const bool is_flat = !std::holds_alternative<Sphere>(s.shape);
    long fields = 0;
    for (int a = 0; a < 3; ++a) {
        if (is_flat && n[a] > 0.999) continue;
        fields += std::lround(std::floor(p[a] / s.checker_size));
    }
    return (fields & 1) != 0;
}

}  // namespace

struct SurfaceSet::Content {
    std::vector<Surface> surfaces;
};

SurfaceSet::SurfaceSet(const std::vector<SurfaceParams>& surfaces, double time,
                       const Vec3d& scene_up) {
    if (surfaces.empty()) return;
    auto content = std::make_shared<Content>();
    for (const SurfaceParams& s : surfaces) {
        content->surfaces.push_back(std::visit(AtTime{time, scene_up}, s));
    }
    content_ = std::move(content);
}

int SurfaceSet::size() const {
    return content_ ? static_cast<int>(content_->surfaces.size()) : 0;
}

std::optional<SurfaceHit> SurfaceSet::intersect(const Ray& ray) const {
    if (!content_) return std::nullopt;
    Ray rest = ray;
    std::optional<Hit> nearest;
    int index = 0;
    for (int i = 0; i < size(); ++i) {
        if (const auto h =
                gischt::intersect(content_->surfaces[static_cast<std::size_t>(i)].shape, rest)) {
            nearest = h;
            rest.t_max = h->t;
            index = i;
        }
    }
    if (!nearest) return std::nullopt;
    const Surface& s = content_->surfaces[static_cast<std::size_t>(index)];
    SurfaceHit hit;
    hit.t = nearest->t;
    hit.point = ray.at(hit.t);
    hit.normal = dot(nearest->normal, ray.direction) > 0 ? -nearest->normal : nearest->normal;
    const bool second = s.checker_size > 0 && is_second_field(s, hit.point, hit.normal);
    hit.albedo = second ? s.checker : s.albedo;
    hit.emission = s.emission;
    hit.surface = index;
    return hit;
}

bool SurfaceSet::is_blocked(const Ray& ray) const {
    if (!content_) return false;
    for (const Surface& s : content_->surfaces) {
        if (gischt::intersect(s.shape, ray)) return true;
    }
    return false;
}

Box3d SurfaceSet::bounds() const {
    Box3d all = Box3d::empty();
    if (!content_) return all;
    for (const Surface& s : content_->surfaces) {
        if (!std::holds_alternative<Plane>(s.shape)) all.extend(gischt::bounds(s.shape));
    }
    return all;
}

Ray leaving_ray(const SurfaceHit& hit, const Vec3d& direction) {
    Ray ray;
    const double step = 1e-6 * (1 + max_component(abs(hit.point)));
    ray.origin = hit.point + step * hit.normal;
    ray.direction = direction;
    return ray;
}

}  // namespace gischt
