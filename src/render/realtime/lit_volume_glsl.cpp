// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/lit_volume_glsl.h"

namespace gischt {

const char* const start_cells_glsl = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Blocks { ivec4 block[]; };
layout(binding = 0, rgba32f) uniform image3D source;
layout(binding = 1) uniform sampler3D density;
layout(binding = 2) uniform sampler3D tint;
layout(binding = 3) uniform sampler3D emission;
layout(binding = 4) uniform sampler3D sky;
uniform ivec3 cells;
uniform int block_count, is_first, has_tint, has_emission, has_sky;
uniform vec3 scattering;
uniform float extinction;

// What a medium takes, glows, and scatters of the sky.
void start_cell(ivec3 at) {
    vec4 sum = vec4(0);
    if (is_first == 0) sum = imageLoad(source, at);
    else if (has_emission != 0) sum.rgb = texelFetch(emission, at, 0).rgb;
    float d = texelFetch(density, at, 0).r;
    sum.a += d * extinction;
    if (d > 0 && has_sky != 0) {
        vec3 s = d * scattering;
        if (has_tint != 0) s *= texelFetch(tint, at, 0).rgb;
        sum.rgb += s * texture(sky, (vec3(at) + 0.5) / vec3(cells)).rgb;
    }
    imageStore(source, at, sum);
}
// A group does one block, each of its invocations a column: setting up an invocation costs llvmpipe
// more than a cell does.
void main() {
    uint b = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (b >= block_count) return;
    ivec3 at = block[b].xyz * 8 + ivec3(gl_LocalInvocationID.xy, 0);
    if (any(greaterThanEqual(at, cells))) return;
    int end = min(at.z + 8, cells.z);
    for (; at.z < end; ++at.z) start_cell(at);
}
)";

const char* const scatter_cells_glsl = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Blocks { ivec4 block[]; };
layout(binding = 0, rgba32f) uniform image3D source;
layout(binding = 1) uniform sampler3D density;
layout(binding = 2) uniform sampler3D tint;
layout(binding = 5) uniform sampler3D light;
layout(binding = 6) uniform sampler2D phase;
uniform ivec3 cells;
uniform int block_count, has_tint, is_colored, is_infinite, has_arrival, is_even, octaves, first_row, rows;
uniform int is_apart, is_first;
uniform vec3 scattering, light_color, light_place, eye, forward, low, cell;
uniform int is_perspective;
uniform vec2 octave[17];  // attenuation, contribution

float phase_of(int o, float c) {
    float u = is_even != 0 ? 0.5 : acos(clamp(c, -1.0, 1.0)) / 3.14159265;
    float steps = float(textureSize(phase, 0).x);
    return texture(phase, vec2((u * (steps - 1) + 0.5) / steps,
                               (float(first_row + o) + 0.5) / float(rows))).r;
}

// What a medium scatters of one light towards the camera; of a light that is kept apart as if no
// medium stood in its way.
void scatter_cell(ivec3 at) {
    if (is_first != 0) imageStore(source, at, vec4(0));
    float d = texelFetch(density, at, 0).r;
    if (d <= 0) return;
    vec4 l = texelFetch(light, at, 0);
    float arrival = has_arrival == 0 ? 1 : is_colored != 0 ? l.a : l.g;
    if (arrival <= 0) return;
    vec3 depth = is_apart != 0 ? vec3(0) : is_colored != 0 ? l.rgb : l.rrr;
    float c = 0;
    if (is_even == 0) {
        vec3 p = low + (vec3(at) + 0.5) * cell;
        vec3 along = is_perspective != 0 ? normalize(p - eye) : forward;
        c = dot(along, is_infinite != 0 ? light_place : normalize(light_place - p));
    }
    vec3 sum = vec3(0);
    for (int o = 0; o < octaves; ++o) {
        sum += octave[o].y * phase_of(o, c) * exp(-octave[o].x * depth);
    }
    vec3 s = d * scattering;
    if (has_tint != 0) s *= texelFetch(tint, at, 0).rgb;
    vec4 before = imageLoad(source, at);
    before.rgb += s * light_color * arrival * sum;
    imageStore(source, at, before);
}
void main() {
    uint b = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (b >= block_count) return;
    ivec3 at = block[b].xyz * 8 + ivec3(gl_LocalInvocationID.xy, 0);
    if (any(greaterThanEqual(at, cells))) return;
    int end = min(at.z + 8, cells.z);
    for (; at.z < end; ++at.z) scatter_cell(at);
}
)";

}  // namespace gischt
