// SPDX-License-Identifier: Apache-2.0
#include "render/billboards/billboard_drawer.h"

#include <cmath>

#include "render/billboards/sprite.h"

namespace gischt {

const char* const billboard_glsl = R"(
uniform int facing;
uniform vec3 fixed_normal;
void billboard_edges(vec3 center, vec3 velocity, float turn, out vec3 edge_x, out vec3 edge_y) {
    vec3 view = is_perspective != 0 ? normalize(center - eye) : forward;
    if (facing == 1 && dot(velocity, velocity) > 0) {
        // Along the motion, and as broad to the viewer as can be.
        edge_x = normalize(velocity);
        vec3 across = cross(edge_x, view);
        float broad = length(across);
        edge_y = broad > 1e-4 ? across / broad : normalize(cross(edge_x, right + 0.5 * up));
        if (dot(cross(edge_x, edge_y), view) > 0) edge_y = -edge_y;
        return;
    }
    vec3 x = right, y = up;
    if (facing == 2) {
        vec3 n = dot(fixed_normal, view) > 0 ? -fixed_normal : fixed_normal;
        // As upright in the picture as they can be, whatever their normal.
        vec3 helper = abs(dot(n, up)) < 0.99 ? up : right;
        x = normalize(cross(helper, n));
        y = cross(n, x);
    }
    float c = cos(turn), s = sin(turn);
    edge_x = c * x + s * y;
    edge_y = c * y - s * x;
}
)";

namespace {

// What a vertex tells of its particle.
const char* const billboard_head = R"(
uniform float size, stretch, spin, pictures, soft_fade;
uniform int is_sequence;
flat out vec4 tint;
flat out vec4 pages;  // two pictures, how much of the second; distance to fade before a surface
void tell(uint i) {
    tint = color[i];
    float page = is_sequence != 0 ? motion[i].w * (pictures - 1) : floor(chance[i].y * pictures);
    pages = vec4(floor(page), min(floor(page) + 1, pictures - 1), fract(page),
                 soft_fade * place[i].w);
}
)";

const char* const square_vertex = R"(
out vec3 uv_z;  // place in the picture, and depth along the view axis
void main() {
    uint i = order[gl_VertexID / 4];
    int corner = gl_VertexID % 4;
    vec2 at = vec2(corner & 1, corner >> 1) * 2 - 1;
    vec3 p = place[i].xyz, velocity = motion[i].xyz, x, y;
    billboard_edges(p, velocity, spin * 6.2831853 * chance[i].x, x, y);
    float half_edge = size * place[i].w;
    float half_length = half_edge + (facing == 1 ? 0.5 * stretch * length(velocity) : 0.0);
    vec3 q = p + at.x * half_length * x + at.y * half_edge * y;
    tell(i);
    uv_z = vec3(0.5 * at + 0.5, dot(q - eye, forward));
    gl_Position = dot(p - eye, forward) > near_plane ? view_projection * vec4(q, 1)
                                                     : vec4(2, 2, 2, 1);
}
)";

// A square that faces the camera is one in the picture: a point that holds it (as it is turned, or
// only the disc in it where the picture is one), in which the fragment turns. Points whose middle
// lies outside of the view are clipped, so the view is widened by a margin.
const char* const point_vertex = R"(
uniform vec2 margin_scale;
uniform int is_round;
flat out vec4 turn_z;  // cosine, sine, edge of the point in edges of the square; depth
void main() {
    uint i = order[gl_VertexID];
    vec3 p = place[i].xyz;
    float z = dot(p - eye, forward), turn = spin * 6.2831853 * chance[i].x;
    float c = cos(turn), s = sin(turn), wide = is_round != 0 ? 1 : abs(c) + abs(s);
    float pixels = size * place[i].w * picture_size.y / (half_size.y * (is_perspective != 0 ? z : 1.0));
    tell(i);
    turn_z = vec4(c, s, wide, z);
    gl_PointSize = max(1.0, pixels * wide);
    vec4 at = view_projection * vec4(p, 1);
    gl_Position = z > near_plane ? vec4(at.xy * margin_scale, at.zw) : vec4(2, 2, 2, 1);
}
)";

const char* const square_place = R"(
in vec3 uv_z;
vec3 place_in_picture() { return uv_z; }
)";

const char* const point_place = R"(
flat in vec4 turn_z;
vec3 place_in_picture() {
    vec2 d = vec2(gl_PointCoord.x - 0.5, 0.5 - gl_PointCoord.y) * turn_z.z;
    return vec3(0.5 + turn_z.x * d.x + turn_z.y * d.y, 0.5 + turn_z.x * d.y - turn_z.y * d.x,
                turn_z.w);
}
)";

const char* const billboard_fragment = R"(
layout(binding = 0) uniform sampler2DArray sprites;
layout(binding = 1) uniform sampler2D opaque_depth;
flat in vec4 tint;
flat in vec4 pages;
void main() {
    vec3 at = place_in_picture();
    if (any(lessThan(at.xy, vec2(0))) || any(greaterThan(at.xy, vec2(1)))) discard;
#ifdef WHITE
    vec4 s = vec4(1, 1, 1, texture(sprites, vec3(at.xy, pages.x)).r);
#else
    vec4 s = texture(sprites, vec3(at.xy, pages.x));
#endif
#ifdef SEQUENCE
    s = mix(s, texture(sprites, vec3(at.xy, pages.y)), pages.z);
#endif
    // What hides is there or not: its opacity does not count.
    float alpha = drops_thin == 0 ? tint.a * s.a : tint.a > 0 ? s.a : 0;
#ifdef SURFACES
    if (pages.w > 0) {
        float behind = texelFetch(opaque_depth, ivec2(gl_FragCoord.xy), 0).r - at.z;
        alpha *= clamp(behind / pages.w, 0.0, 1.0);
    }
#endif
    emit(tint.rgb * s.rgb, alpha, at.z);
}
)";

// llvmpipe pays for what a shader leaves out by a condition, so there is one for each case.
GlProgram billboard_program(GlDevice& device, bool is_point, bool has_surfaces,
                            const SpriteSheet& sheet) {
    std::string vertex = camera_glsl, fragment;
    for (const char* part : {particle_glsl, billboard_glsl, billboard_head}) vertex += part;
    vertex += is_point ? point_vertex : square_vertex;
    if (sheet.is_sequence) fragment += "#define SEQUENCE\n";
    if (has_surfaces) fragment += "#define SURFACES\n";
    if (sheet.is_white) fragment += "#define WHITE\n";
    fragment += particle_fragment_glsl;
    fragment += is_point ? point_place : square_place;
    fragment += billboard_fragment;
    return GlProgram(device, is_point ? "billboard_points" : "billboards",
                     {{GlStageKind::Vertex, vertex}, {GlStageKind::Fragment, fragment}});
}

}  // namespace

BillboardDrawer::BillboardDrawer(GlDevice& device, const BillboardsParams& params)
    : device_(device), params_(params), stage_(device, params_.draw) {
    const SpriteSheet sheet = make_sprites(params_);
    const Vec3i size(sheet.width, sheet.height, sheet.count);
    sprites_ = GlTexture(
        device, {GlShape::Array, sheet.is_white ? GlFormat::R32F : GlFormat::Rgba32F, size},
        sheet.texels.data());
    is_sequence_ = sheet.is_sequence;
    is_round_ = sheet.is_round;
    for (int surfaces = 0; surfaces < 2; ++surfaces) {
        squares_[surfaces] = billboard_program(device, false, surfaces == 1, sheet);
        points_[surfaces] = billboard_program(device, true, surfaces == 1, sheet);
    }
}

// Two triangles for the four corners of each square.
void BillboardDrawer::upload(const View& view, Job& job) {
    stage_.upload(view, "billboards", job);
    std::vector<std::uint32_t> corners;
    for (int i = 0; i < stage_.cloud().count(); ++i) {
        const auto first = 4 * static_cast<std::uint32_t>(i);
        for (const std::uint32_t c : {0u, 1u, 2u, 2u, 1u, 3u}) corners.push_back(first + c);
    }
    corners_ = GlBuffer(device_, corners);
}

void BillboardDrawer::draw(const DrawOrder& order, const OpaqueLayer& opaque,
                           const GlFramebuffer& target) {
    const GlCamera camera = stage_.camera(order);
    stage_.bind(camera);
    target.bind();
    opaque.draw(camera, order.as_depth);
    if (stage_.cloud().count() == 0) return;
    // Where all squares face the camera and none is too large, points are several times as fast.
    const double widest = params_.spin && !is_round_ ? std::sqrt(2.0) : 1;
    const double pixels = 2 * widest * params_.size * stage_.cloud().largest_in_pixels(camera);
    const bool is_point = params_.facing == BillboardFacing::Camera &&
                          pixels <= static_cast<double>(device_.limits().point_size);
    const GlProgram& program = (is_point ? points_ : squares_)[opaque.has_surfaces() ? 1 : 0];
    program.use();
    stage_.set(program, camera, order);
    program.set("facing", static_cast<int>(params_.facing));
    program.set("fixed_normal", Vec3f(normalize(params_.normal)));
    program.set("size", static_cast<float>(params_.size));
    program.set("stretch", static_cast<float>(params_.stretch));
    program.set("spin", params_.spin ? 1.0f : 0.0f);
    program.set("pictures", static_cast<float>(sprites_.spec().size.z));
    program.set("is_sequence", is_sequence_ ? 1 : 0);
    program.set("soft_fade", static_cast<float>(params_.soft_fade));
    sprites_.bind(0);
    opaque.depth().bind(1);
    GlDraw draw = stage_.draw(order.as_depth);
    if (is_point) {
        const int margin = static_cast<int>(pixels / 2) + 1;
        const auto scale = [&](int edge) {
            return static_cast<float>(edge) / static_cast<float>(edge + 2 * margin);
        };
        program.set("margin_scale", Vec2f{scale(target.size().x), scale(target.size().y)});
        program.set("is_round", is_round_ ? 1 : 0);
        draw.primitive = GlPrimitive::Points;
        draw.count = stage_.cloud().count();
        device_.set_margin(margin);
        device_.draw(draw);
        device_.set_margin(0);
    } else {
        draw.count = 6 * stage_.cloud().count();
        draw.indices = corners_.id();
        device_.draw(draw);
    }
}

}  // namespace gischt
