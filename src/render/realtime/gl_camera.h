// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/objects.h"
#include "optics/camera.h"

namespace gischt {

// A camera as shaders know it: a pinhole at one moment. To keep the digits of floats, shaders see
// points relative to an origin near what is shown.
struct GlCamera {
    // `shift` in pixels moves the points of the picture at which it is taken, for smooth edges:
    // pixel (x, y) shows (x + 1/2 + shift.x, y + 1/2 + shift.y). `reach`: metres that the scene
    // extends around the origin.
    GlCamera(const Camera& camera, const Vec3d& origin, double reach, Vec2d shift = {0, 0});

    Vec3f position;            // relative to the origin; of parallel rays: the middle of them
    Vec3f forward, right, up;  // unit
    bool is_perspective = true;
    // Half the picture's edges at depth 1, or in metres; and what the shift adds to the middle.
    Vec2f half, middle;
    Vec2f picture;            // pixels
    float near = 0, far = 0;  // of the depth buffer: near / z, or 1 - z / far for parallel rays
    GlMatrix view_projection{};

    // The uniforms that camera_glsl declares.
    void set(const GlProgram& program) const;
    bool operator==(const GlCamera&) const = default;
};

// GLSL: uniforms, ray_of(gl_FragCoord.xy) and what turns depths along the axis into those of the
// buffer.
extern const char* const camera_glsl;

// The vertex stage that covers the picture; draw with the defaults of GlDraw.
extern const char* const whole_picture_glsl;

}  // namespace gischt
