// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/opaque_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"

namespace gischt {
namespace {

constexpr float nowhere = 1e30f;  // metres: what shaders take for infinity

const char* const paint_source = R"(
layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D depth;
uniform int as_depth;
out vec4 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float z = texelFetch(depth, at, 0).r;
    bool is_hit = z < 1e29;
    result = as_depth == 0 ? texelFetch(radiance, at, 0)
                           : is_hit ? vec4(z, 0, 0, 1) : vec4(0);
    gl_FragDepth = is_hit ? buffer_depth(z) : 0;
}
)";

}  // namespace

OpaquePainter::OpaquePainter(const View& view, const LitGrid& grid) : view_(view), grid_(grid) {
    if (view.surfaces.is_empty()) return;
    for (const Light* light : grid.broad) open_sky_.emplace_back(*light);
}

// Lambert reflection of all lights.
Vec3f OpaquePainter::shade(const SurfaceHit& hit, Vec2f u) const {
    Vec3f irradiance;
    for (const GridLight& light : grid_.lights) {
        const LightSample s = light.light->sample(hit.point, u);
        const double cosine = dot(s.direction, hit.normal);
        if (cosine <= 0 || max_component(s.weight) <= 0) continue;
        Ray shadow = leaving_ray(hit, s.direction);
        shadow.t_max = s.distance;
        if (view_.surfaces.is_blocked(shadow)) continue;
        irradiance += static_cast<float>(cosine) * s.weight *
                      grid_.transmittance(light, hit.point, s.direction);
    }
    const float seen = open_sky_.empty() ? 1 : grid_.sky_seen(hit.point);
    for (const IrradianceMap& sky : open_sky_) irradiance += seen * sky(hit.normal);
    return hit.emission + static_cast<float>(1 / pi) * hit.albedo * irradiance;
}

OpaqueImage OpaquePainter::paint(const Camera& camera, Vec2d shift, Vec2f u, Job& job) const {
    OpaqueImage image;
    image.width = camera.width();
    image.height = camera.height();
    image.has_surfaces = !view_.surfaces.is_empty();
    const std::size_t pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    image.radiance.resize(4 * pixels);
    image.depth.assign(pixels, std::numeric_limits<float>::infinity());
    parallel_for(image.height, 4, [&](int row) {
        job.check();
        std::size_t at = static_cast<std::size_t>(image.height - 1 - row) *
                         static_cast<std::size_t>(image.width);
        for (int x = 0; x < image.width; ++x, ++at) {
            const Ray ray = camera.ray(x + 0.5 + shift.x, row + 0.5 + shift.y);
            Vec3f radiance;
            float alpha = 1;
            const auto hit = view_.surfaces.intersect(ray, 0.5f, RayKind::Camera);
            if (hit) {
                radiance = shade(*hit, u);
                image.depth[at] = static_cast<float>(camera.depth(ray, hit->t));
            } else {
                const BackgroundSample behind = background(view_, ray.direction);
                radiance = behind.radiance;
                alpha = behind.alpha;
            }
            for (int c = 0; c < 3; ++c) {
                image.radiance[4 * at + static_cast<std::size_t>(c)] = radiance[c];
            }
            image.radiance[4 * at + 3] = alpha;
        }
    });
    return image;
}

OpaqueLayer::OpaqueLayer(GlDevice& device)
    : device_(device),
      program_(device, "opaque_layer",
               {{GlStageKind::Vertex, whole_picture_glsl},
                {GlStageKind::Fragment, std::string(camera_glsl) + paint_source}}) {}

void OpaqueLayer::upload(const OpaqueImage& image) {
    const Vec3i size(image.width, image.height, 1);
    if (radiance_.is_empty() || radiance_.spec().size != size) {
        radiance_ = GlTexture(device_, {GlShape::Flat, GlFormat::Rgba32F, size, false});
        depth_ = GlTexture(device_, {GlShape::Flat, GlFormat::R32F, size, false});
    }
    radiance_.write(image.radiance.data());
    std::vector<float> depth = image.depth;
    for (float& z : depth) z = std::min(z, nowhere);
    depth_.write(depth.data());
    has_surfaces_ = image.has_surfaces;
}

void OpaqueLayer::draw(const GlCamera& camera, bool as_depth) const {
    device_.clear_depth(0);
    radiance_.bind(0);
    depth_.bind(1);
    program_.use();
    camera.set(program_);
    program_.set("as_depth", as_depth ? 1 : 0);
    GlDraw draw;
    draw.depth = GlDepth::TestAndWrite;
    device_.draw(draw);
}

}  // namespace gischt
