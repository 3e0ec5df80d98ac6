// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/gl_camera.h"

#include <algorithm>

namespace gischt {

const char* const camera_glsl = R"(
uniform mat4 view_projection;
uniform vec3 eye, forward, right, up;
uniform vec2 half_size, middle, picture_size;
uniform float near_plane, far_plane;
uniform int is_perspective;

// Through a point of the picture in pixels: origin and unit direction.
void ray_of(vec2 pixel, out vec3 origin, out vec3 direction) {
    vec2 at = (2 * pixel / picture_size - 1) * half_size + middle;
    vec3 offset = at.x * right + at.y * up;
    origin = is_perspective != 0 ? eye : eye + offset;
    direction = is_perspective != 0 ? normalize(forward + offset) : forward;
}
float buffer_depth(float z) {
    return is_perspective != 0 ? min(near_plane / z, 1.0) : clamp(1 - z / far_plane, 0.0, 1.0);
}
)";

const char* const whole_picture_glsl = R"(
void main() {
    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4 * at - 1, 0, 1);
}
)";

GlCamera::GlCamera(const Camera& camera, const Vec3d& origin, double reach, Vec2d shift)
    : position(camera.position() - origin),
      forward(camera.forward()),
      right(camera.right()),
      up(camera.up()),
      is_perspective(camera.projection() == Projection::Perspective) {
    const double pixel = camera.pixel_size(1);
    half = {static_cast<float>(0.5 * pixel * camera.width()),
            static_cast<float>(0.5 * pixel * camera.height())};
    middle = {static_cast<float>(shift.x * pixel), static_cast<float>(-shift.y * pixel)};
    picture = {static_cast<float>(camera.width()), static_cast<float>(camera.height())};
    // Reversed depths: a near plane close to the eye costs no digits.
    const double distance = length(camera.position() - origin);
    near = static_cast<float>(1e-4 * std::max(reach, 1e-3 * distance));
    far = static_cast<float>(2 * (distance + reach));

    // Rows of the matrix as functions of a point relative to the origin.
    const auto row = [&](int r, const Vec3f& v, float w) {
        const auto at = static_cast<std::size_t>(r);
        view_projection[at] = v.x;
        view_projection[4 + at] = v.y;
        view_projection[8 + at] = v.z;
        view_projection[12 + at] = w;
    };
    const float z0 = -dot(forward, position);
    const auto lateral = [&](int r, const Vec3f& axis, float edge, float center) {
        const float offset = -dot(axis, position);
        if (is_perspective) {
            row(r, (axis - center * forward) / Vec3f(edge), (offset - center * z0) / edge);
        } else {
            row(r, axis / Vec3f(edge), (offset - center) / edge);
        }
    };
    lateral(0, right, half.x, middle.x);
    lateral(1, up, half.y, middle.y);
    if (is_perspective) {
        row(2, Vec3f(0), near);
        row(3, forward, z0);
    } else {
        row(2, forward * (-1 / far), 1 - z0 / far);
        row(3, Vec3f(0), 1);
    }
}

void GlCamera::set(const GlProgram& program) const {
    program.set("view_projection", view_projection);
    program.set("eye", position);
    program.set("forward", forward);
    program.set("right", right);
    program.set("up", up);
    program.set("half_size", half);
    program.set("middle", middle);
    program.set("picture_size", picture);
    program.set("near_plane", near);
    program.set("far_plane", far);
    program.set("is_perspective", is_perspective ? 1 : 0);
}

}  // namespace gischt
