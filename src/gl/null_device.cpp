// SPDX-License-Identifier: Apache-2.0
#include "gl/null_device.h"

#include <fmt/format.h>

#include <cstring>

namespace gischt {

void NullDevice::read_buffer(GlId, std::size_t, std::size_t bytes, void* data) {
    std::memset(data, 0, bytes);
}

void NullDevice::read_texture(GlId, const GlTextureSpec& spec, void* data) {
    std::memset(data, 0, volume(spec.size) * texel_bytes(spec.format));
}

void NullDevice::read_pixels(GlId, const Vec2i& size, float* rgba) {
    std::memset(rgba, 0, volume(Vec3i(size.x, size.y, 4)) * sizeof(float));
}

void NullDevice::set_target(GlId framebuffer, const Vec2i& size) {
    calls.push_back(fmt::format("target {} {}x{}", framebuffer, size.x, size.y));
}

void NullDevice::clear_color(int attachment, const std::array<float, 4>& v) {
    calls.push_back(fmt::format("clear {} {} {} {} {}", attachment, v[0], v[1], v[2], v[3]));
}

void NullDevice::clear_depth(float depth) {
    calls.push_back(fmt::format("clear depth {}", depth));
}

void NullDevice::use(GlId program) {
    calls.push_back(fmt::format("use {}", program));
}

void NullDevice::draw(const GlDraw& draw) {
    draws.push_back(draw);
    calls.push_back(fmt::format("draw {} + {} x {}", draw.first, draw.count, draw.instances));
}

void NullDevice::dispatch(const Vec3i& groups) {
    calls.push_back(fmt::format("dispatch {} {} {}", groups.x, groups.y, groups.z));
}

}  // namespace gischt
