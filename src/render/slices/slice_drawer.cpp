// SPDX-License-Identifier: Apache-2.0
#include "render/slices/slice_drawer.h"

#include <cmath>
#include <limits>

#include "render/slices/slice_glsl.h"
#include "render/slices/slice_stack.h"

namespace gischt {
namespace {

// Slice `gl_InstanceID` of a run, four corners of the box each.
const char* const slice_vertex = R"(
uniform vec3 low, high;
uniform int axis, u_axis, v_axis;
uniform float first, step_size;
out vec3 place;
void main() {
    vec3 p;
    p[axis] = first + float(gl_InstanceID) * step_size;
    p[u_axis] = (gl_VertexID & 1) == 0 ? low[u_axis] : high[u_axis];
    p[v_axis] = (gl_VertexID & 2) == 0 ? low[v_axis] : high[v_axis];
    place = p;
    gl_Position = view_projection * vec4(place, 1);
}
)";

// Rows of a mesh whose corners are the centres of the cells: one instance per row.
const char* const mesh_vertex = R"(
layout(binding = 0) uniform sampler3D source;
layout(binding = 1) uniform sampler3D extinction;
uniform vec3 low, cell;
uniform int axis, u_axis, v_axis, first_layer, layer_step, rows, is_colored;
out vec3 place;
out vec4 corner_source;
out vec3 corner_extinction;
void main() {
    ivec3 at;
    at[axis] = first_layer + gl_InstanceID / rows * layer_step;
    at[v_axis] = gl_InstanceID % rows + (gl_VertexID & 1);
    at[u_axis] = gl_VertexID >> 1;
    place = low + (vec3(at) + 0.5) * cell;
    corner_source = texelFetch(source, at, 0);
    corner_extinction = is_colored == 0 ? corner_source.aaa : texelFetch(extinction, at, 0).rgb;
    gl_Position = view_projection * vec4(place, 1);
}
)";

const char* const values_of_texture = R"(
layout(binding = 0) uniform sampler3D source;
layout(binding = 1) uniform sampler3D extinction;
uniform vec3 low, high;
in vec3 place;
vec4 source_here() { return texture(source, (place - low) / (high - low)); }
vec3 extinction_here() { return texture(extinction, (place - low) / (high - low)).rgb; }
)";

const char* const values_of_corners = R"(
in vec3 place;
in vec4 corner_source;
in vec3 corner_extinction;
vec4 source_here() { return corner_source; }
vec3 extinction_here() { return corner_extinction; }
)";

// Where all channels lose the same: one factor, the coverage.
const char* const grey_fragment = R"(
uniform int as_depth;
out vec4 result;
void main() {
    vec4 s = source_here();
    if (s == vec4(0)) discard;
    vec2 length_and_z = slab();
    float depth = s.a * length_and_z.x;
    float lost = 1 - exp(-depth);
    float gain = depth < 1e-3 ? 1 - 0.5 * depth : lost / depth;
    result = vec4(s.rgb * (gain * length_and_z.x), lost);
    if (as_depth != 0) result = vec4(length_and_z.y * lost, 0, 0, lost);
}
)";

const char* const colored_fragment = R"(
layout(location = 0, index = 0) out vec4 result;
layout(location = 0, index = 1) out vec4 through;
uniform int as_depth;
void main() {
    vec4 s = source_here();
    if (s == vec4(0)) discard;
    vec2 length_and_z = slab();
    vec3 depth = extinction_here() * length_and_z.x;
    vec3 t = exp(-depth);
    vec3 gain = mix((1 - t) / max(depth, 1e-9), 1 - 0.5 * depth, lessThan(depth, vec3(1e-3)));
    float lost = 1 - dot(t, vec3(1.0 / 3));
    result = vec4(s.rgb * gain * length_and_z.x, lost);
    if (as_depth != 0) result = vec4(length_and_z.y * lost, 0, 0, lost);
    through = as_depth != 0 ? vec4(1 - lost) : vec4(t, 1 - lost);
}
)";

const char* const mix_source = R"(
layout(binding = 0) uniform sampler2D stack;
out vec4 result;
void main() { result = texelFetch(stack, ivec2(gl_FragCoord.xy), 0); }
)";

// llvmpipe pays for what a shader leaves out by a condition, so there is one for each case.
GlProgram slice_program(GlDevice& device, bool is_mesh, bool is_grey, bool has_surfaces) {
    std::string vertex = camera_glsl, fragment = has_surfaces ? "#define SURFACES\n" : "";
    vertex += is_mesh ? mesh_vertex : slice_vertex;
    for (const char* part : {camera_glsl, is_mesh ? values_of_corners : values_of_texture,
                             slab_glsl, is_grey ? grey_fragment : colored_fragment}) {
        fragment += part;
    }
    return GlProgram(device, is_mesh ? "slice_meshes" : "slices",
                     {{GlStageKind::Vertex, vertex}, {GlStageKind::Fragment, fragment}});
}

}  // namespace

SliceDrawer::SliceDrawer(GlDevice& device, const SlicesParams& params)
    : device_(device),
      params_(params),
      mix_(device, "slice_mix",
           {{GlStageKind::Vertex, whole_picture_glsl}, {GlStageKind::Fragment, mix_source}}),
      volume_(device) {
    if (params.kind == SliceKind::HalfAngle) {
        half_angle_ = std::make_unique<HalfAngleSlices>(device, params);
        return;
    }
    const bool is_mesh = params.sampling == SliceSampling::Vertex;
    for (int surfaces = 0; surfaces < 2; ++surfaces) {
        grey_[surfaces] = slice_program(device, is_mesh, true, surfaces == 1);
        colored_[surfaces] = slice_program(device, is_mesh, false, surfaces == 1);
    }
}

void SliceDrawer::upload(const View& view, Job& job) {
    if (grid_ && grid_->holds_for(view)) return;
    grid_.reset();
    LitGrid grid(view, params_.grid, "slices", job);
    if (half_angle_ && !grid.is_empty()) {
        volume_.upload(grid, half_angle_->choose_light(grid));
    } else {
        volume_.upload(grid);
    }
    grid_ = std::move(grid);
}

void SliceDrawer::draw(const DrawOrder& order, const OpaqueLayer& opaque,
                       const GlFramebuffer& target) {
    const GlCamera camera(order.camera, volume_.origin(), volume_.reach(), order.shift);
    target.bind();
    opaque.draw(camera, order.as_depth);
    if (volume_.is_empty()) return;
    volume_.shade(camera);
    if (half_angle_) {
        half_angle_->draw(volume_, camera, order, opaque, target);
        return;
    }

    // The view direction is that to the middle of the box: at the edges of a wide picture the
    // camera's own axis says little about the rays there.
    const Vec3d to_middle(-camera.position);
    const bool is_beside = camera.is_perspective && length(to_middle) > 1e-6 * volume_.reach();
    const std::array<double, 3> shares =
        stack_shares(is_beside ? to_middle : Vec3d(camera.forward), params_.fade);
    int stacks = 0;
    for (const double s : shares) stacks += s > 0;
    bool is_first = true;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = shares[static_cast<std::size_t>(axis)];
        if (share == 0) continue;
        if (stacks == 1) {
            draw_stack(axis, camera, order, opaque);
            return;
        }
        if (!scratch_ || scratch_->size() != target.size())
            scratch_.emplace(device_, target.size());
        scratch_->bind();
        opaque.draw(camera, order.as_depth);
        draw_stack(axis, camera, order, opaque);
        mix(*scratch_, share, is_first, target);
        is_first = false;
    }
}

void SliceDrawer::draw_stack(int axis, const GlCamera& camera, const DrawOrder& order,
                             const OpaqueLayer& opaque) {
    const bool is_mesh = params_.sampling == SliceSampling::Vertex;
    const GlProgram& program =
        (volume_.is_grey() ? grey_ : colored_)[opaque.has_surfaces() ? 1 : 0];
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const Vec3d half = 0.5 * volume_.box().size(), cell = half * 2.0 / Vec3d(volume_.cells());
    const int layers = volume_.cells()[axis];
    const int count =
        is_mesh ? layers : std::max(1, static_cast<int>(std::lround(layers / params_.spacing)));
    volume_.source().bind(0);
    if (!volume_.is_grey()) volume_.extinction().bind(1);
    opaque.depth().bind(2);
    program.use();
    camera.set(program);
    program.set("low", Vec3f(-half));
    program.set("high", Vec3f(half));
    program.set("cell", Vec3f(cell));
    program.set("axis", axis);
    Vec3f across;
    across[axis] = 1;
    program.set("across", across);
    program.set("u_axis", u);
    program.set("v_axis", v);
    program.set("is_colored", volume_.is_grey() ? 0 : 1);
    program.set("as_depth", order.as_depth ? 1 : 0);
    program.set("spacing", static_cast<float>(2 * half[axis] / count));

    // Parallel rays see all slices from one side.
    constexpr double far = std::numeric_limits<double>::infinity();
    const double eye = camera.is_perspective      ? static_cast<double>(camera.position[axis])
                       : camera.forward[axis] > 0 ? -far
                                                  : far;
    const double phase = is_mesh ? 0.5 : static_cast<double>(order.phase);
    GlDraw draw = over_draw(volume_.is_grey());
    draw.primitive = GlPrimitive::TriangleStrip;
    for (const SliceRun& run : slice_runs(-half[axis], half[axis], count, phase, eye)) {
        if (is_mesh) {
            const bool rises = run.step > 0;
            const int rows = std::max(1, volume_.cells()[v] - 1);
            program.set("first_layer", rises ? 0 : layers - 1);
            program.set("layer_step", rises ? 1 : -1);
            program.set("rows", rows);
            draw.count = 2 * volume_.cells()[u];
            draw.instances = run.count * rows;
        } else {
            program.set("first", static_cast<float>(run.first));
            program.set("step_size", static_cast<float>(run.step));
            draw.count = 4;
            draw.instances = run.count;
        }
        device_.draw(draw);
    }
}

// Adds a share of a stack's picture.
void SliceDrawer::mix(const GlFramebuffer& stack, double share, bool is_first,
                      const GlFramebuffer& target) {
    target.bind();
    stack.color().bind(0);
    mix_.use();
    const auto s = static_cast<float>(share);
    GlDraw draw;
    draw.blend = GlBlend{BlendFactor::ConstantColor,
                         is_first ? BlendFactor::Zero : BlendFactor::One,
                         BlendFactor::ConstantColor,
                         is_first ? BlendFactor::Zero : BlendFactor::One,
                         {s, s, s, s}};
    device_.draw(draw);
}

}  // namespace gischt
