// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "math/ray.h"
#include "math/transform.h"

namespace gischt {

// Analytic solids at one moment, in metres.
struct Sphere {
    Vec3d center;
    double radius = 1;
};

// Box with the given edge lengths around its centre, turned by `rotation` (no translation, no
// scale).
struct SolidBox {
    Vec3d center, size{1, 1, 1};
    Transform rotation;
};

// Half space below the plane through `point` with the unit vector `normal`; its surface is
// unbounded.
struct Plane {
    Vec3d point, normal{0, 0, 1};
};

// Thin sheets, which have no inside. Their outer side is that of the normal.

// center + a edge_x + b edge_y for a, b in [-1/2, 1/2]; the edges are perpendicular, the normal
// has the direction of their cross product.
struct Rectangle {
    Vec3d center, edge_x{1, 0, 0}, edge_y{0, 1, 0};
    Vec3d normal() const { return normalize(cross(edge_x, edge_y)); }
};
struct Disc {
    Vec3d center, normal{0, 0, 1};
    double radius = 1;
};

using Shape = std::variant<Sphere, SolidBox, Plane, Rectangle, Disc>;

// Distance to the surface in metres, negative inside; exact. Never negative for a thin sheet.
double signed_distance(const Shape& shape, const Vec3d& point);

struct Hit {
    double t = 0;  // in lengths of the ray's direction
    Vec3d normal;  // unit, pointing out of the solid
    int face = 0;  // of a box: 2 axis, + 1 on the positive side
};

// First intersection with the surface inside [t_min, t_max], from either side.
std::optional<Hit> intersect(const Shape& shape, const Ray& ray);

// Box around the solid; a plane's is unbounded (+-infinity).
Box3d bounds(const Shape& shape);

}  // namespace gischt
