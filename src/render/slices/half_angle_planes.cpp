// SPDX-License-Identifier: Apache-2.0
#include "render/slices/half_angle_planes.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace gischt {
namespace {

const char* const other_kind_hint = "move it away, or take kind = \"axis\"";

void refuse_near(const char* what) {
    throw Error(ErrorKind::Usage, "slices",
                std::string("half-angle slices need ") + what +
                    " farther from the media, for it would see slices from both sides",
                other_kind_hint);
}

Vec3d corner(const Vec3d& half, int i) {
    return {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
}

// Whether all of the box lies before the plane across `across` through that point.
bool sees_one_side(const SeenFrom& from, const Vec3d& across, double extent) {
    return from.is_infinite || dot(across, from.place) > extent;
}

}  // namespace

HalfAnglePlanes half_angle_planes(const Vec3d& half, const Vec3d& cell, double spacing,
                                  double phase, const SeenFrom& eye, const SeenFrom& light) {
    // In the middle of the media neither has a direction.
    const double reach = length(half);
    if (length(eye.place) < 1e-6 * reach) refuse_near("the eye");
    if (length(light.place) < 1e-6 * reach) refuse_near("the light");
    const Vec3d to_eye = normalize(eye.place), to_light = normalize(light.place);
    HalfAnglePlanes planes;
    planes.is_front_to_back = dot(to_eye, to_light) >= 0;
    const double side = planes.is_front_to_back ? 1 : -1;
    planes.across = normalize(to_light + side * to_eye);

    const double extent = dot(abs(planes.across), half);
    if (!sees_one_side(eye, side * planes.across, extent)) refuse_near("the eye");
    if (!sees_one_side(light, planes.across, extent)) refuse_near("the light");

    const double distance = spacing * length(planes.across * cell);
    planes.count = std::max(1, static_cast<int>(std::ceil(2 * extent / distance)));
    planes.step = -2 * extent / planes.count;
    planes.first = extent + phase * planes.step;

    orthonormal_frame(planes.across, planes.s, planes.t);
    const double s = dot(abs(planes.s), half), t = dot(abs(planes.t), half);
    planes.s_range = {-s, s};
    planes.t_range = {-t, t};
    return planes;
}

GlMatrix light_projection(const Vec3d& half, const SeenFrom& light) {
    const Vec3d forward = -1.0 * normalize(light.place);
    Vec3d s, t;
    orthonormal_frame(forward, s, t);
    const double distance = light.is_infinite ? 0 : length(light.place);
    // Half the edge of the picture: metres, or metres at depth 1.
    double edge = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3d c = corner(half, i);
        const double lateral = std::max(std::abs(dot(c, s)), std::abs(dot(c, t)));
        const double depth = light.is_infinite ? 1 : distance + dot(c, forward);
        if (depth <= 0) refuse_near("the light");
        edge = std::max(edge, lateral / depth);
    }
    if (!light.is_infinite && edge > std::tan(70 * pi / 180)) refuse_near("the light");

    GlMatrix m{};
    const auto row = [&](std::size_t r, const Vec3d& v, double w) {
        for (std::size_t a = 0; a < 3; ++a) {
            m[4 * a + r] = static_cast<float>(v[static_cast<int>(a)]);
        }
        m[12 + r] = static_cast<float>(w);
    };
    row(0, s / Vec3d(edge), 0);
    row(1, t / Vec3d(edge), 0);
    if (light.is_infinite) {
        row(3, Vec3d(0), 1);
    } else {
        row(3, forward, distance);
    }
    return m;
}

}  // namespace gischt
