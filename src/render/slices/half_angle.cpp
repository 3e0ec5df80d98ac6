// SPDX-License-Identifier: Apache-2.0
#include "render/slices/half_angle.h"

#include "base/error.h"
#include "image/color.h"
#include "render/slices/slice_glsl.h"

namespace gischt {
namespace {

const char* const plane_vertex = R"(
uniform mat4 projection;
uniform vec3 across, s_axis, t_axis;
uniform vec2 s_range, t_range;
uniform float at;
out vec3 place;
void main() {
    float s = (gl_VertexID & 1) == 0 ? s_range.x : s_range.y;
    float t = (gl_VertexID & 2) == 0 ? t_range.x : t_range.y;
    place = at * across + s * s_axis + t * t_axis;
    gl_Position = projection * vec4(place, 1);
}
)";

// Of both passes: the volume, and the piece of the light's way that a slice stands for.
const char* const matter_fragment = R"(
layout(binding = 0) uniform sampler3D source;
layout(binding = 1) uniform sampler3D extinction;
uniform vec3 low, high, light_place;
uniform int is_colored, is_infinite;
in vec3 place;
vec3 in_box() { return (place - low) / (high - low); }
bool is_outside(vec3 q) { return any(lessThan(q, vec3(0))) || any(greaterThan(q, vec3(1))); }
float light_slab(vec3 normal, float distance) {
    vec3 along = is_infinite != 0 ? light_place : normalize(light_place - place);
    return distance / max(abs(dot(along, normal)), 1e-4);
}
)";

const char* const dim_fragment = R"(
uniform vec3 across;
uniform float spacing;
out vec4 result;
void main() {
    vec3 q = in_box();
    if (is_outside(q)) discard;
    vec3 e = is_colored != 0 ? texture(extinction, q).rgb : texture(source, q).aaa;
    result = vec4(exp(-e * light_slab(across, spacing)), 1);
}
)";

// A pixel is written by one fragment of each slice, which therefore may read what it holds: it is
// added to from the front, where each channel keeps what the slices before let through, or covered
// from behind. Source and light are constant within a slab: eq. 19, the light being that of its
// middle.
const char* const gather_fragment = R"(
layout(binding = 3) uniform sampler3D lit;
layout(binding = 4) uniform sampler2D light_left;
layout(binding = 0, rgba32f) uniform image2D gathered;
layout(binding = 1, rgba32f) uniform image2D passing;
uniform mat4 light_projection;
uniform int is_front_to_back, as_depth;
out vec4 unused;

vec3 light_here() {
    vec4 seen = light_projection * vec4(place, 1);
    ivec2 size = textureSize(light_left, 0);
    vec2 at = (seen.xy / seen.w * 0.5 + 0.5) * vec2(size) - 0.5;
    vec2 f = fract(at);
    ivec2 a = clamp(ivec2(floor(at)), ivec2(0), size - 1), b = min(a + 1, size - 1);
    vec3 below = mix(texelFetch(light_left, a, 0).rgb,
                     texelFetch(light_left, ivec2(b.x, a.y), 0).rgb, f.x);
    vec3 above = mix(texelFetch(light_left, ivec2(a.x, b.y), 0).rgb,
                     texelFetch(light_left, b, 0).rgb, f.x);
    return mix(below, above, f.y);
}
void main() {
    unused = vec4(0);
    vec3 q = in_box();
    if (is_outside(q)) discard;
    vec4 s = texture(source, q);
    if (s == vec4(0)) discard;
    vec3 e = is_colored != 0 ? texture(extinction, q).rgb : s.aaa;
    vec3 light = light_here() * exp(-0.5 * e * light_slab(across, spacing));
    vec2 length_and_z = slab();
    vec3 depth = e * length_and_z.x;
    vec3 t = exp(-depth);
    vec3 gain = mix((1 - t) / max(depth, 1e-9), 1 - 0.5 * depth, lessThan(depth, vec3(1e-3)));
    float lost = 1 - dot(t, vec3(1.0 / 3));
    vec4 adds = vec4((s.rgb + light * texture(lit, q).rgb) * gain * length_and_z.x, lost);
    vec4 lets = vec4(t, 1 - lost);
    if (as_depth != 0) {
        adds = vec4(length_and_z.y * lost, 0, 0, lost);
        lets = vec4(1 - lost);
    }
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 before = imageLoad(gathered, pixel), passes = imageLoad(passing, pixel);
    imageStore(gathered, pixel,
               is_front_to_back != 0 ? before + passes * adds : adds + lets * before);
    imageStore(passing, pixel, passes * lets);
}
)";

const char* const over_fragment = R"(
layout(binding = 0) uniform sampler2D gathered;
layout(binding = 1) uniform sampler2D passing;
layout(location = 0, index = 0) out vec4 result;
layout(location = 0, index = 1) out vec4 through;
void main() {
    result = texelFetch(gathered, ivec2(gl_FragCoord.xy), 0);
    through = texelFetch(passing, ivec2(gl_FragCoord.xy), 0);
}
)";

[[noreturn]] void refuse(const char* what, const char* hint) {
    throw Error(ErrorKind::Usage, "slices", std::string("half-angle slices ") + what, hint);
}

// What reaches the dense cells of a grid without media in the way, in the mean, W/m^2.
double mean_arrival(const LitGrid& grid, const GridLight& light) {
    if (light.arrival.empty()) return luminance(light.color);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < light.arrival.size(); ++i) {
        for (const auto& m : grid.matter.media) {
            if (m.density[i] <= 0) continue;
            sum += static_cast<double>(light.arrival[i]);
            ++count;
            break;
        }
    }
    return count == 0 ? 0 : luminance(light.color) * sum / static_cast<double>(count);
}

}  // namespace

HalfAngleSlices::HalfAngleSlices(GlDevice& device, const SlicesParams& params)
    : device_(device), params_(params) {
    if (params.sampling == SliceSampling::Vertex) {
        refuse("have no meshes to take colours at",
               "take sampling = \"texture\" or kind = \"axis\"");
    }
    for (int surfaces = 0; surfaces < 2; ++surfaces) {
        std::string fragment = surfaces == 1 ? "#define SURFACES\n" : "";
        for (const char* part : {camera_glsl, matter_fragment, slab_glsl, gather_fragment}) {
            fragment += part;
        }
        eye_[surfaces] =
            GlProgram(device, "half_angle_eye",
                      {{GlStageKind::Vertex, plane_vertex}, {GlStageKind::Fragment, fragment}});
    }
    dim_ = GlProgram(device, "half_angle_light",
                     {{GlStageKind::Vertex, plane_vertex},
                      {GlStageKind::Fragment, std::string(matter_fragment) + dim_fragment}});
    mix_ = GlProgram(
        device, "half_angle_over",
        {{GlStageKind::Vertex, whole_picture_glsl}, {GlStageKind::Fragment, over_fragment}});
    buffer_ = GlFramebuffer(device, {params.light_pixels, params.light_pixels});
}

std::size_t HalfAngleSlices::choose_light(const LitGrid& grid) {
    for (const GridMedium& m : grid.media) {
        if (m.octaves.size() > 1) {
            refuse("follow light once: octaves of multiple_scattering need more than one buffer",
                   "leave the octaves out, or take kind = \"axis\"");
        }
    }
    if (grid.lights.empty()) {
        refuse("need a sun, point or spot light", "add one, or take kind = \"axis\"");
    }
    std::size_t best = 0;
    double most = 0;
    for (std::size_t i = 0; i < grid.lights.size(); ++i) {
        const double arrives = mean_arrival(grid, grid.lights[i]);
        if (arrives > most) {
            best = i;
            most = arrives;
        }
    }
    const GridLight& light = grid.lights[best];
    const Box3d& box = grid.matter.box;
    light_ = {light.is_infinite ? light.place : light.place - 0.5 * (box.lo + box.hi),
              light.is_infinite};
    projection_ = light_projection(0.5 * box.size(), light_);
    return best;
}

// Uniforms of both passes.
void HalfAngleSlices::set_common(const GlProgram& program, const LitVolume& volume,
                                 const HalfAnglePlanes& planes) const {
    const auto floats = [](const Vec2d& v) {
        return Vec2f{static_cast<float>(v.x), static_cast<float>(v.y)};
    };
    const Vec3f half(0.5 * volume.box().size());
    program.set("low", -half);
    program.set("high", half);
    program.set("across", Vec3f(planes.across));
    program.set("s_axis", Vec3f(planes.s));
    program.set("t_axis", Vec3f(planes.t));
    program.set("s_range", floats(planes.s_range));
    program.set("t_range", floats(planes.t_range));
    program.set("spacing", static_cast<float>(-planes.step));
    program.set("light_place", Vec3f(light_.place));
    program.set("is_infinite", light_.is_infinite ? 1 : 0);
    program.set("is_colored", volume.is_grey() ? 0 : 1);
}

void HalfAngleSlices::draw(const LitVolume& volume, const GlCamera& camera, const DrawOrder& order,
                           const OpaqueLayer& opaque, const GlFramebuffer& target) {
    const Vec3d half = 0.5 * volume.box().size();
    const SeenFrom eye = camera.is_perspective ? SeenFrom{Vec3d(camera.position), false}
                                               : SeenFrom{Vec3d(-camera.forward), true};
    const HalfAnglePlanes planes =
        half_angle_planes(half, 2.0 * half / Vec3d(volume.cells()), params_.spacing,
                          static_cast<double>(order.phase), eye, light_);

    if (!gathered_ || gathered_->size() != target.size()) {
        gathered_.emplace(device_, target.size(), 2);
    }
    gathered_->bind();
    device_.clear_color(0, {0, 0, 0, 0});
    device_.clear_color(1, {1, 1, 1, 1});
    buffer_.bind();
    device_.clear_color(0, {1, 1, 1, 1});

    const GlProgram& gather = eye_[opaque.has_surfaces() ? 1 : 0];
    set_common(dim_, volume, planes);
    dim_.set("projection", projection_);
    set_common(gather, volume, planes);
    camera.set(gather);
    gather.set("projection", camera.view_projection);
    gather.set("light_projection", projection_);
    gather.set("is_front_to_back", planes.is_front_to_back ? 1 : 0);
    gather.set("as_depth", order.as_depth ? 1 : 0);
    volume.source().bind(0);
    if (!volume.is_grey()) volume.extinction().bind(1);
    opaque.depth().bind(2);
    volume.lit().bind(3);
    buffer_.color().bind(4);
    gathered_->color(0).bind_image(0);
    gathered_->color(1).bind_image(1);

    // Fragments of the eye write images and leave the target as it is.
    GlDraw add, dim;
    add.primitive = dim.primitive = GlPrimitive::TriangleStrip;
    add.count = dim.count = 4;
    add.blend =
        GlBlend{BlendFactor::Zero, BlendFactor::One, BlendFactor::Zero, BlendFactor::One, {}};
    dim.blend = GlBlend{
        BlendFactor::Zero, BlendFactor::SrcColor, BlendFactor::Zero, BlendFactor::SrcAlpha, {}};
    for (int i = 0; i < planes.count; ++i) {
        const auto at = static_cast<float>(planes.first + i * planes.step);
        target.bind();
        gather.use();
        gather.set("at", at);
        device_.draw(add);
        device_.barrier();
        buffer_.bind();
        dim_.use();
        dim_.set("at", at);
        device_.draw(dim);
    }
    target.bind();
    gathered_->color(0).bind(0);
    gathered_->color(1).bind(1);
    mix_.use();
    device_.draw(over_draw(false));
}

}  // namespace gischt
