// SPDX-License-Identifier: Apache-2.0
#include "render/points/point_drawer.h"

namespace gischt {
namespace {

const char* const point_vertex = R"(
uniform float size, least_size;
out vec4 point_color;
out float point_z;
void main() {
    uint i = order[gl_VertexID];
    vec3 p = place[i].xyz;
    float z = dot(p - eye, forward);
    float pixels = place[i].w * picture_size.y / (half_size.y * (is_perspective != 0 ? z : 1.0));
    float wanted = size > 0 ? size : pixels;
    gl_PointSize = max(wanted, least_size);
    point_color = color[i];
    // What is smaller than a point covers less of it.
    float share = wanted / gl_PointSize;
    point_color.a *= share * share;
    point_z = z;
    gl_Position = z > near_plane ? view_projection * vec4(p, 1) : vec4(2, 2, 2, 1);
}
)";

const char* const point_fragment = R"(
in vec4 point_color;
in float point_z;
void main() {
    vec2 d = 2 * gl_PointCoord - 1;
    if (dot(d, d) > 1) discard;
    emit(point_color.rgb, drops_thin == 0 ? point_color.a : point_color.a > 0 ? 1.0 : 0.0, point_z);
}
)";

}  // namespace

PointDrawer::PointDrawer(GlDevice& device, const PointsParams& params)
    : device_(device),
      params_(params),
      program_(device, "points",
               {{GlStageKind::Vertex, std::string(camera_glsl) + particle_glsl + point_vertex},
                {GlStageKind::Fragment, std::string(particle_fragment_glsl) + point_fragment}}),
      stage_(device, params_.draw) {}

void PointDrawer::draw(const DrawOrder& order, const OpaqueLayer& opaque,
                       const GlFramebuffer& target) {
    const GlCamera camera = stage_.camera(order);
    stage_.bind(camera);
    target.bind();
    opaque.draw(camera, order.as_depth);
    if (stage_.cloud().count() == 0) return;
    program_.use();
    stage_.set(program_, camera, order);
    program_.set("size", static_cast<float>(params_.size));
    program_.set("least_size", static_cast<float>(params_.least_size));
    GlDraw draw = stage_.draw(order.as_depth);
    draw.primitive = GlPrimitive::Points;
    draw.count = stage_.cloud().count();
    device_.draw(draw);
}

}  // namespace gischt
