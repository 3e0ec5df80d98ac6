// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "math/box.h"
#include "math/vec.h"

namespace gischt {

// Affine map p -> M p + t. `column[a]` is the image of unit vector a.
struct Transform {
    std::array<Vec3d, 3> column{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
    Vec3d translation{};

    static Transform scale_translate(double scale, const Vec3d& translation) {
        return {{Vec3d{scale, 0, 0}, Vec3d{0, scale, 0}, Vec3d{0, 0, scale}}, translation};
    }
    // Rotation by `angle` radians around the unit vector `axis` (Rodrigues).
    static Transform rotation(const Vec3d& axis, double angle) {
        const double c = std::cos(angle), s = std::sin(angle);
        Transform r;
        for (int a = 0; a < 3; ++a) {
            Vec3d e;
            e[a] = 1;
            r.column[static_cast<std::size_t>(a)] =
                c * e + s * cross(axis, e) + (1 - c) * axis[a] * axis;
        }
        return r;
    }
    Vec3d vector(const Vec3d& v) const {
        return v.x * column[0] + v.y * column[1] + v.z * column[2];
    }
    Vec3d point(const Vec3d& p) const { return vector(p) + translation; }
    double determinant() const { return dot(column[0], cross(column[1], column[2])); }
    // Product: (*this)(b(p)).
    Transform operator*(const Transform& b) const {
        return {{vector(b.column[0]), vector(b.column[1]), vector(b.column[2])},
                point(b.translation)};
    }
    // Undefined where determinant() is 0.
    Transform inverse() const {
        const double d = 1 / determinant();
        const Vec3d r0 = d * cross(column[1], column[2]), r1 = d * cross(column[2], column[0]),
                    r2 = d * cross(column[0], column[1]);
        Transform inv;
        inv.column = {Vec3d{r0.x, r1.x, r2.x}, Vec3d{r0.y, r1.y, r2.y}, Vec3d{r0.z, r1.z, r2.z}};
        inv.translation = -inv.vector(translation);
        return inv;
    }
    // Smallest axis-aligned box around the image of a box.
    Box3d bounds(const Box3d& b) const {
        Box3d out = Box3d::empty();
        for (int c = 0; c < 8; ++c) {
            out.extend(
                point({c & 1 ? b.hi.x : b.lo.x, c & 2 ? b.hi.y : b.lo.y, c & 4 ? b.hi.z : b.lo.z}));
        }
        return out;
    }
    bool operator==(const Transform&) const = default;
};

}  // namespace gischt
