// SPDX-License-Identifier: Apache-2.0
#include "shape/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gischt {
namespace {

double distance(const Sphere& s, const Vec3d& p) {
    return length(p - s.center) - s.radius;
}

double distance(const SolidBox& b, const Vec3d& p) {
    const Vec3d q = abs(b.rotation.inverse().vector(p - b.center)) - 0.5 * b.size;
    return length(max(q, Vec3d(0))) + std::min(max_component(q), 0.0);
}

double distance(const Plane& s, const Vec3d& p) {
    return dot(p - s.point, s.normal);
}

double distance(const Rectangle& r, const Vec3d& p) {
    const Vec3d d = p - r.center;
    const auto beyond = [&](const Vec3d& edge) {
        const double l = length(edge);
        return std::max(0.0, std::abs(dot(d, edge)) / l - 0.5 * l);
    };
    return length(Vec3d{beyond(r.edge_x), beyond(r.edge_y), dot(d, r.normal())});
}

double distance(const Disc& s, const Vec3d& p) {
    const double h = dot(p - s.center, s.normal);
    const double r = length(p - s.center - h * s.normal);
    return std::hypot(h, std::max(0.0, r - s.radius));
}

std::optional<Hit> hit(const Sphere& s, const Ray& ray) {
    // Roots of a t^2 + 2 b t + c in the form that does not cancel (Haines et al. 2019, Ray Tracing
    // Gems, chapter 7).
    const Vec3d f = ray.origin - s.center;
    const double a = dot(ray.direction, ray.direction), b = dot(f, ray.direction);
    const Vec3d closest = f - (b / a) * ray.direction;
    const double rest = s.radius * s.radius - dot(closest, closest);
    if (rest < 0) return std::nullopt;
    const double q = -(b + std::copysign(std::sqrt(a * rest), b));
    const double c = dot(f, f) - s.radius * s.radius;
    double t0 = q / a, t1 = q != 0 ? c / q : t0;
    if (t0 > t1) std::swap(t0, t1);
    const double t = t0 >= ray.t_min ? t0 : t1;
    if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
    return Hit{t, normalize(ray.at(t) - s.center)};
}

std::optional<Hit> hit(const SolidBox& b, const Ray& ray) {
    const Transform to_local = b.rotation.inverse();
    const Vec3d o = to_local.vector(ray.origin - b.center), d = to_local.vector(ray.direction);
    double t0 = -std::numeric_limits<double>::infinity(), t1 = -t0;
    int axis0 = 0, axis1 = 0;
    for (int a = 0; a < 3; ++a) {
        const double half = 0.5 * b.size[a];
        if (d[a] == 0) {
            if (std::abs(o[a]) > half) return std::nullopt;
            continue;
        }
        double near = (-half - o[a]) / d[a], far = (half - o[a]) / d[a];
        if (near > far) std::swap(near, far);
        if (near > t0) t0 = near, axis0 = a;
        if (far < t1) t1 = far, axis1 = a;
    }
    if (t0 > t1) return std::nullopt;
    const bool enters = t0 >= ray.t_min;
    const double t = enters ? t0 : t1;
    if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
    const int axis = enters ? axis0 : axis1;
    Vec3d normal;
    normal[axis] = (d[axis] > 0) == enters ? -1 : 1;
    return Hit{t, b.rotation.vector(normal), 2 * axis + (normal[axis] > 0)};
}

std::optional<Hit> hit(const Plane& s, const Ray& ray) {
    const double slope = dot(ray.direction, s.normal);
    if (slope == 0) return std::nullopt;
    const double t = dot(s.point - ray.origin, s.normal) / slope;
    if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
    return Hit{t, s.normal};
}

std::optional<Hit> hit(const Rectangle& r, const Ray& ray) {
    const auto h = hit(Plane{r.center, r.normal()}, ray);
    if (!h) return h;
    const Vec3d d = ray.at(h->t) - r.center;
    const bool is_inside = std::abs(dot(d, r.edge_x)) <= 0.5 * dot(r.edge_x, r.edge_x) &&
                           std::abs(dot(d, r.edge_y)) <= 0.5 * dot(r.edge_y, r.edge_y);
    return is_inside ? h : std::nullopt;
}

std::optional<Hit> hit(const Disc& s, const Ray& ray) {
    const auto h = hit(Plane{s.center, s.normal}, ray);
    if (!h) return h;
    const Vec3d d = ray.at(h->t) - s.center;
    return dot(d, d) <= s.radius * s.radius ? h : std::nullopt;
}

Box3d box(const Sphere& s) {
    return {s.center - Vec3d(s.radius), s.center + Vec3d(s.radius)};
}

Box3d box(const SolidBox& b) {
    Transform place = b.rotation;
    place.translation = b.center;
    return place.bounds({-0.5 * b.size, 0.5 * b.size});
}

Box3d box(const Plane&) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {Vec3d(-inf), Vec3d(inf)};
}

Box3d box(const Rectangle& r) {
    const Vec3d half = 0.5 * (abs(r.edge_x) + abs(r.edge_y));
    return {r.center - half, r.center + half};
}

Box3d box(const Disc& s) {
    Vec3d half;
    for (int a = 0; a < 3; ++a) {
        half[a] = s.radius * std::sqrt(std::max(0.0, 1 - s.normal[a] * s.normal[a]));
    }
    return {s.center - half, s.center + half};
}

}  // namespace

double signed_distance(const Shape& shape, const Vec3d& point) {
    return std::visit([&](const auto& s) { return distance(s, point); }, shape);
}

std::optional<Hit> intersect(const Shape& shape, const Ray& ray) {
    return std::visit([&](const auto& s) { return hit(s, ray); }, shape);
}

Box3d bounds(const Shape& shape) {
    return std::visit([](const auto& s) { return box(s); }, shape);
}

}  // namespace gischt
