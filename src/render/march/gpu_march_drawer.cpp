// SPDX-License-Identifier: Apache-2.0
#include "render/march/gpu_march_drawer.h"

namespace gischt {
namespace {

const char* const march_head = R"(
layout(binding = 0) uniform sampler3D source;
layout(binding = 1) uniform sampler3D extinction;
layout(binding = 2) uniform sampler2D opaque_depth;
layout(binding = 3) uniform sampler3D blocks;
uniform vec3 low, high, block_size;
uniform float cell, step_cells, step_depth, cutoff, phase;
uniform int as_depth, has_surfaces;
)";

const char* const grey_head = R"(
#define LOSS float
LOSS extinction_at(vec3 at, vec4 s) { return s.a; }
float strongest(float t) { return t; }
float mean_of(float t) { return t; }
vec3 gain_of(float depth) {
    return vec3(depth < 1e-3 ? 1 - 0.5 * depth : (1 - exp(-depth)) / depth);
}
out vec4 result;
void finish(vec4 color, float t) { result = color; }
)";

const char* const colored_head = R"(
#define LOSS vec3
LOSS extinction_at(vec3 at, vec4 s) { return texture(extinction, at).rgb; }
float strongest(vec3 t) { return max(t.r, max(t.g, t.b)); }
float mean_of(vec3 t) { return dot(t, vec3(1.0 / 3)); }
vec3 gain_of(vec3 depth) {
    return mix((1 - exp(-depth)) / max(depth, 1e-9), 1 - 0.5 * depth,
               lessThan(depth, vec3(1e-3)));
}
layout(location = 0, index = 0) out vec4 result;
layout(location = 0, index = 1) out vec4 through;
void finish(vec4 color, vec3 t) {
    result = color;
    through = as_depth != 0 ? vec4(1 - color.a) : vec4(t, 1 - color.a);
}
)";

const char* const march_source = R"(
// Evenly spread over neighbouring pixels (Jimenez 2014, interleaved gradient noise).
float jitter() {
    vec2 p = floor(gl_FragCoord.xy);
    return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715))) + phase);
}

void main() {
    vec3 origin, along;
    ray_of(gl_FragCoord.xy, origin, along);
    vec3 inverse = 1 / (along + vec3(equal(along, vec3(0))) * 1e-20);
    vec3 a = (low - origin) * inverse, b = (high - origin) * inverse;
    vec3 nearer = min(a, b), farther = max(a, b);
    float t = max(max(nearer.x, max(nearer.y, nearer.z)), 0.0);
    float end = min(farther.x, min(farther.y, farther.z));
    if (has_surfaces != 0) {
        float z = texelFetch(opaque_depth, ivec2(gl_FragCoord.xy), 0).r;
        end = min(end, z / dot(along, forward));
    }
    if (t >= end) discard;

    vec3 radiance = vec3(0);
    LOSS transmittance = LOSS(1);
    float depth_sum = 0, offset = jitter();
    ivec3 last = textureSize(blocks, 0) - 1;
    ivec3 at = clamp(ivec3((origin + t * along - low) / block_size), ivec3(0), last);
    ivec3 way = ivec3(sign(along));
    // From block to block (Amanatides & Woo 1987).
    for (int guard = 0; guard < 4096 && t < end; ++guard) {
        vec3 faces = (low + vec3(at + max(way, ivec3(0))) * block_size - origin) * inverse;
        faces = mix(faces, vec3(1e30), equal(way, ivec3(0)));
        float leave = min(min(faces.x, min(faces.y, faces.z)), end);
        float most = texelFetch(blocks, at, 0).r;
        float run = leave - t;
        if (most > 0 && run > 0) {
            int steps = int(ceil(run * max(1 / (step_cells * cell), most / step_depth)));
            steps = clamp(steps, 1, 4096);
            float ds = run / float(steps);
            for (int i = 0; i < steps; ++i) {
                float here = t + (float(i) + offset) * ds;
                vec3 p = (origin + here * along - low) / (high - low);
                vec4 s = texture(source, p);
                if (s == vec4(0)) continue;
                LOSS depth = extinction_at(p, s) * ds;
                LOSS kept = exp(-depth);
                radiance += transmittance * gain_of(depth) * ds * s.rgb;
                depth_sum += mean_of(transmittance * (1 - kept)) * here;
                transmittance *= kept;
                if (strongest(transmittance) <= cutoff) break;
            }
        }
        if (strongest(transmittance) <= cutoff) {
            transmittance = LOSS(0);
            break;
        }
        t = max(t, leave);
        // The next block through the nearest face.
        if (faces.x <= faces.y && faces.x <= faces.z) at.x += way.x;
        else if (faces.y <= faces.z) at.y += way.y;
        else at.z += way.z;
        if (any(lessThan(at, ivec3(0))) || any(greaterThan(at, last))) break;
    }
    float lost = 1 - mean_of(transmittance);
    if (lost == 0 && radiance == vec3(0)) discard;
    vec4 color = as_depth != 0 ? vec4(depth_sum * dot(along, forward), 0, 0, lost)
                               : vec4(radiance, lost);
    finish(color, transmittance);
}
)";

GlProgram march_program(GlDevice& device, bool is_grey) {
    return GlProgram(
        device, "gpu_march",
        {{GlStageKind::Vertex, whole_picture_glsl},
         {GlStageKind::Fragment, std::string(camera_glsl) + march_head +
                                     (is_grey ? grey_head : colored_head) + march_source}});
}

}  // namespace

GpuMarchDrawer::GpuMarchDrawer(GlDevice& device, const GpuMarchParams& params)
    : device_(device),
      params_(params),
      grey_(march_program(device, true)),
      colored_(march_program(device, false)),
      volume_(device) {}

void GpuMarchDrawer::upload(const View& view, Job& job) {
    if (grid_ && grid_->holds_for(view)) return;
    grid_.emplace(view, params_.grid, "gpu_march", job);
    volume_.upload(*grid_);
}

void GpuMarchDrawer::draw(const DrawOrder& order, const OpaqueLayer& opaque,
                          const GlFramebuffer& target) {
    const GlCamera camera(order.camera, volume_.origin(), volume_.reach(), order.shift);
    target.bind();
    opaque.draw(camera, order.as_depth);
    if (volume_.is_empty()) return;
    volume_.shade(camera);

    const GlProgram& program = volume_.is_grey() ? grey_ : colored_;
    const Vec3d half = 0.5 * volume_.box().size(), cell = 2.0 * half / Vec3d(volume_.cells());
    volume_.source().bind(0);
    if (!volume_.is_grey()) volume_.extinction().bind(1);
    opaque.depth().bind(2);
    volume_.blocks().bind(3);
    program.use();
    camera.set(program);
    program.set("low", Vec3f(-half));
    program.set("high", Vec3f(half));
    program.set("block_size", Vec3f(static_cast<double>(LitVolume::block) * cell));
    program.set("cell", static_cast<float>(min_component(cell)));
    program.set("step_cells", static_cast<float>(params_.step));
    program.set("step_depth", static_cast<float>(params_.step_depth));
    program.set("cutoff", static_cast<float>(params_.cutoff));
    program.set("phase", order.phase);
    program.set("as_depth", order.as_depth ? 1 : 0);
    program.set("has_surfaces", opaque.has_surfaces() ? 1 : 0);
    device_.draw(over_draw(volume_.is_grey()));
}

}  // namespace gischt
