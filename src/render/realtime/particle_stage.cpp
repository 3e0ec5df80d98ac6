// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/particle_stage.h"

#include <numeric>

namespace gischt {

const char* const particle_glsl = R"(
layout(std430, binding = 0) readonly buffer Places { vec4 place[]; };
layout(std430, binding = 1) readonly buffer Motions { vec4 motion[]; };
layout(std430, binding = 2) readonly buffer Chances { vec4 chance[]; };
layout(std430, binding = 3) readonly buffer Colors { vec4 color[]; };
layout(std430, binding = 4) readonly buffer Order { uint order[]; };
uniform int count;
)";

const char* const particle_fragment_glsl = R"(
uniform int as_depth, drops_thin;
out vec4 result;
void emit(vec3 radiance, float alpha, float z) {
    if (alpha <= 0 || (drops_thin != 0 && alpha < 0.5)) discard;
    if (as_depth != 0) result = drops_thin != 0 ? vec4(z, 0, 0, 1) : vec4(z * alpha, 0, 0, alpha);
    else result = vec4(radiance, drops_thin != 0 ? 1.0 : alpha);
}
)";

const Table<ParticleDrawParams>& particle_draw_table() {
    using P = ParticleDrawParams;
    static const Table<P> table =
        Table<P>("particle_draw", "How particles are lit, blended and ordered")
            .flat(&P::shading, particle_shading_table())
            .flat(&P::blend, blend_table())
            .choice("order", &P::order,
                    {{"sorted", ParticleOrder::Sorted, "the farthest first"},
                     {"unsorted", ParticleOrder::Unsorted,
                      "as they come, without writing depth: faster, exact for additive blending"}},
                    {.help = "In which order they are drawn"})
            .flat(&P::grid, grid_params_table());
    return table;
}

ParticleStage::ParticleStage(GlDevice& device, const ParticleDrawParams& params)
    : device_(device), params_(params), cloud_(device), sort_(device) {}

void ParticleStage::upload(const View& view, std::string_view method, Job& job) {
    const bool holds = grid_ && grid_->holds_for(view);
    if (holds && frames_ == view.frames) return;
    if (!holds) grid_.emplace(view, params_.grid, method, job);
    frames_ = view.frames;
    cloud_.upload(view, *grid_, params_.shading, method);
    std::vector<std::uint32_t> identity(static_cast<std::size_t>(cloud_.count()));
    std::iota(identity.begin(), identity.end(), 0u);
    identity_ = GlBuffer(device_, identity);
}

// What hides what is behind it needs no order.
bool ParticleStage::is_sorted() const {
    return params_.order == ParticleOrder::Sorted && !is_opaque(params_.blend);
}

void ParticleStage::bind(const GlCamera& camera) {
    cloud_.shade(camera);
    if (is_sorted()) sort_.sort(cloud_.places(), cloud_.count(), camera);
    device_.bind_storage(0, cloud_.places().id());
    device_.bind_storage(1, cloud_.motions().id());
    device_.bind_storage(2, cloud_.chances().id());
    device_.bind_storage(3, cloud_.colors().id());
    device_.bind_storage(4, is_sorted() ? sort_.order().id() : identity_.id());
}

GlDraw ParticleStage::draw(bool as_depth) const {
    GlDraw draw;
    draw.depth = is_opaque(params_.blend) ? GlDepth::TestAndWrite : GlDepth::Test;
    draw.blend = blend_of(params_.blend);
    if (as_depth && draw.blend) {
        draw.blend = GlBlend{BlendFactor::One,
                             BlendFactor::OneMinusSrcAlpha,
                             BlendFactor::One,
                             BlendFactor::OneMinusSrcAlpha,
                             {}};
    }
    return draw;
}

void ParticleStage::set(const GlProgram& program, const GlCamera& camera,
                        const DrawOrder& order) const {
    camera.set(program);
    program.set("count", cloud_.count());
    program.set("as_depth", order.as_depth ? 1 : 0);
    program.set("drops_thin", is_opaque(params_.blend) ? 1 : 0);
}

}  // namespace gischt
