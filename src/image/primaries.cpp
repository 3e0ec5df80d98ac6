// SPDX-License-Identifier: Apache-2.0
#include "image/primaries.h"

namespace gischt {
namespace {

// XYZ of a chromaticity at Y = 1.
Vec3d xyz_of(const Vec2d& c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

Transform matrix(const Vec3d& column_0, const Vec3d& column_1, const Vec3d& column_2) {
    return {{column_0, column_1, column_2}, {}};
}

Transform diagonal(const Vec3d& d) {
    return matrix({d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z});
}

}  // namespace

Transform rgb_to_xyz(const Primaries& p) {
    const Transform unscaled = matrix(xyz_of(p.red), xyz_of(p.green), xyz_of(p.blue));
    return unscaled * diagonal(unscaled.inverse().vector(xyz_of(p.white)));
}

Transform convert_primaries(const Primaries& from, const Primaries& to) {
    const Transform bradford =
        matrix({0.8951, -0.7502, 0.0389}, {0.2664, 1.7135, -0.0685}, {-0.1614, 0.0367, 1.0296});
    const Vec3d white_from = bradford.vector(xyz_of(from.white));
    const Vec3d white_to = bradford.vector(xyz_of(to.white));
    const Transform adapt = bradford.inverse() * diagonal(white_to / white_from) * bradford;
    return rgb_to_xyz(to).inverse() * adapt * rgb_to_xyz(from);
}

}  // namespace gischt
