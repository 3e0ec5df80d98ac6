// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "base/error.h"
#include "gl/null_device.h"
#include "gl/objects.h"

namespace gischt {
namespace {

const GlStage whole_screen{GlStageKind::Vertex, R"(
void main() {
    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4 * at - 1, 0.5, 1);
}
)"};
const GlStage one_color{GlStageKind::Fragment, R"(
uniform vec4 color;
out vec4 result;
void main() { result = color; }
)"};

TEST(Gl, HasAContextWithoutAWindow) {
    const GlLimits& limits = offscreen_device().limits();
    EXPECT_FALSE(limits.renderer.empty());
    EXPECT_GE(limits.volume_size, 512);
    EXPECT_EQ(&offscreen_device(), &offscreen_device());
}

TEST(Gl, GivesEachThreadItsOwn) {
    GlDevice* here = &offscreen_device();
    GlDevice* there = nullptr;
    float value = 0;
    std::thread([&] {
        there = &offscreen_device();
        const GlBuffer buffer(*there, std::vector<float>{7});
        value = buffer.read<float>(1)[0];
    }).join();
    EXPECT_NE(here, there);
    EXPECT_EQ(value, 7);
}

TEST(Gl, KeepsFloatsExactly) {
    GlDevice& device = offscreen_device();
    for (const GlShape shape : {GlShape::Flat, GlShape::Volume, GlShape::Array}) {
        const Vec3i size(3, 5, shape == GlShape::Flat ? 1 : 4);
        std::vector<float> values(volume(size) * 4);
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = std::sqrt(static_cast<float>(i)) * 1e6f;
        }
        const GlTexture texture(device, {shape, GlFormat::Rgba32F, size}, values.data());
        EXPECT_EQ(texture.read(), values);
    }
}

TEST(Gl, DrawsAndReadsBack) {
    GlDevice& device = offscreen_device();
    const GlProgram program(device, "fill", {whole_screen, one_color});
    const GlFramebuffer target(device, {5, 3});
    target.bind();
    device.clear_color(0, {0, 0, 0, 0});
    program.use();
    program.set("color", std::array<float, 4>{0.25f, 3e5f, -1, 1});
    device.draw({});
    const std::vector<float> rgba = target.read();
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        EXPECT_EQ(rgba[i], 0.25f);
        EXPECT_EQ(rgba[i + 1], 3e5f);
        EXPECT_EQ(rgba[i + 2], -1);
    }
}

// Depth is reversed: what is cleared to 0 is infinitely far.
TEST(Gl, NearerDepthsWin) {
    GlDevice& device = offscreen_device();
    const GlStage at_depth{GlStageKind::Vertex, R"(
uniform float depth;
void main() {
    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4 * at - 1, depth, 1);
}
)"};
    const GlProgram program(device, "fill", {at_depth, one_color});
    const GlFramebuffer target(device, {1, 1});
    target.bind();
    device.clear_color(0, {0, 0, 0, 0});
    device.clear_depth(0);
    program.use();
    GlDraw draw;
    draw.depth = GlDepth::TestAndWrite;
    for (const float depth : {0.5f, 0.7f, 0.6f}) {
        program.set("depth", depth);
        program.set("color", std::array<float, 4>{depth, 0, 0, 1});
        device.draw(draw);
    }
    EXPECT_EQ(target.read()[0], 0.7f);
    EXPECT_EQ(target.depth().read()[0], 0.7f);
}

TEST(Gl, Computes) {
    GlDevice& device = offscreen_device();
    const GlProgram program(device, "square", {{GlStageKind::Compute, R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Values { float value[]; };
uniform int count;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) value[i] *= value[i];
}
)"}});
    std::vector<float> values(1000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    const GlBuffer buffer(device, values);
    device.bind_storage(0, buffer.id());
    program.use();
    program.set("count", 1000);
    device.dispatch({16, 1, 1});
    device.barrier();
    const std::vector<float> squares = buffer.read<float>(1000);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(squares[i], values[i] * values[i]);
}

TEST(Gl, NamesTheLineOfABadShader) {
    const GlStage bad{GlStageKind::Fragment, "out vec4 c;\nvoid main() {\n    c = nonsense;\n}\n"};
    try {
        const GlProgram program(offscreen_device(), "wrong", {whole_screen, bad});
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.where(), "wrong:3");
        EXPECT_NE(e.fact().find("nonsense"), std::string::npos);
    }
}

TEST(Gl, RefusesTexturesBeyondTheLimits) {
    GlDevice& device = offscreen_device();
    const Vec3i size(device.limits().volume_size + 1, 1, 1);
    EXPECT_THROW(GlTexture(device, {GlShape::Volume, GlFormat::R32F, size}), Error);
    EXPECT_THROW(GlTexture(device, {GlShape::Flat, GlFormat::R32F, {0, 1, 1}}), Error);
}

TEST(Gl, TimesWork) {
    GlDevice& device = offscreen_device();
    const GlProgram program(device, "fill", {whole_screen, one_color});
    const GlFramebuffer target(device, {256, 256});
    target.bind();
    program.use();
    GlTimer timer(device);
    timer.begin();
    for (int i = 0; i < 20; ++i) device.draw({});
    timer.end();
    EXPECT_GT(timer.seconds(), 0);
    EXPECT_LT(timer.seconds(), 60);
}

TEST(NullDevice, WritesDownAndForgetsObjects) {
    NullDevice device;
    {
        const GlFramebuffer target(device, {4, 2});
        EXPECT_EQ(device.objects, 3);
        target.bind();
        GlDraw draw;
        draw.count = 9;
        device.draw(draw);
        EXPECT_EQ(target.read(), std::vector<float>(32, 0));
    }
    EXPECT_EQ(device.objects, 0);
    ASSERT_EQ(device.draws.size(), 1u);
    EXPECT_EQ(device.draws[0].count, 9);
}

}  // namespace
}  // namespace gischt
