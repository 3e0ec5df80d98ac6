// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/blending.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/random.h"
#include "render/realtime/depth_sort.h"
#include "render/realtime/test_scenes.h"

namespace gischt {
namespace {

using Rgba = std::array<float, 4>;

// Eq. 4's factor of one channel (3: alpha), by the table of the OpenGL specification.
float factor_of(BlendFactor factor, const Rgba& src, const Rgba& dst, const Rgba& constant,
                std::size_t c) {
    using F = BlendFactor;
    switch (factor) {
        case F::Zero:
            return 0;
        case F::One:
            return 1;
        case F::SrcColor:
            return src[c];
        case F::OneMinusSrcColor:
            return 1 - src[c];
        case F::DstColor:
            return dst[c];
        case F::OneMinusDstColor:
            return 1 - dst[c];
        case F::SrcAlpha:
            return src[3];
        case F::OneMinusSrcAlpha:
            return 1 - src[3];
        case F::DstAlpha:
            return dst[3];
        case F::OneMinusDstAlpha:
            return 1 - dst[3];
        case F::ConstantColor:
            return constant[c];
        case F::OneMinusConstantColor:
            return 1 - constant[c];
        case F::ConstantAlpha:
            return constant[3];
        case F::OneMinusConstantAlpha:
            return 1 - constant[3];
        default:
            return -1;
    }
}

TEST(Blending, FollowsTheArithmeticOfEveryFactor) {
    GlDevice& device = offscreen_device();
    const GlProgram program(
        device, "blend_test",
        {{GlStageKind::Vertex, whole_picture_glsl},
         {GlStageKind::Fragment,
          "uniform vec4 color;\nout vec4 result;\nvoid main() { result = color; }\n"}});
    const GlFramebuffer target(device, {1, 1});
    const Rgba src{0.7f, 0.2f, 3.5f, 0.6f}, dst{0.3f, 1.5f, 0.1f, 0.8f},
        constant{0.25f, 0.5f, 0.75f, 0.4f};
    for (int s = 0; s < 14; ++s) {
        for (int d = 0; d < 14; ++d) {
            BlendParams params;
            params.source = static_cast<BlendFactor>(s);
            params.destination = static_cast<BlendFactor>(d);
            params.constant_color = {0.25, 0.5, 0.75};
            params.constant_alpha = 0.4;
            target.bind();
            device.clear_color(0, dst);
            program.use();
            program.set("color", src);
            GlDraw draw;
            draw.blend = blend_of(params);
            device.draw(draw);
            const std::vector<float> out = target.read();
            for (std::size_t c = 0; c < 4; ++c) {
                const float expected =
                    src[c] * factor_of(*params.source, src, dst, constant, c) +
                    dst[c] * factor_of(*params.destination, src, dst, constant, c);
                EXPECT_NEAR(out[c], expected, 1e-6f) << s << " " << d << " channel " << c;
            }
        }
    }
}

TEST(Blending, PresetsKeepAlphaTheCoverage) {
    EXPECT_FALSE(blend_of({.preset = BlendPreset::Opaque,
                           .source = {},
                           .destination = {},
                           .constant_color = {},
                           .constant_alpha = 1}));
    BlendParams params;
    params.preset = BlendPreset::Additive;
    EXPECT_EQ(blend_of(params)->source_alpha, BlendFactor::Zero);
    EXPECT_EQ(blend_of(params)->destination, BlendFactor::One);
    params.preset = BlendPreset::Smoke;
    EXPECT_EQ(blend_of(params)->source, BlendFactor::SrcAlpha);
    EXPECT_EQ(blend_of(params)->source_alpha, BlendFactor::One);
    params.destination = BlendFactor::DstColor;
    EXPECT_EQ(blend_of(params)->destination_alpha, BlendFactor::DstColor);
}

// Depths that differ, which tells the order; those behind the camera count as one.
TEST(DepthSort, OrdersFromBackToFront) {
    GlDevice& device = offscreen_device();
    DepthSort sort(device);
    for (const int count : {1, 2, 255, 1024, 1025, 5000, 70000, 300}) {
        std::vector<std::array<float, 4>> places;
        std::vector<float> depth;
        const GlCamera camera(test_camera({0, -2, 0}), {}, 1);
        for (int i = 0; i < count; ++i) {
            const auto n = static_cast<std::uint32_t>(i);
            // Some lie behind the camera, some at the same depth.
            const float y = 6 * random_uniform(3, n) - 3;
            places.push_back({random_uniform(1, n), i % 7 ? y : 0.5f, random_uniform(2, n), 0});
            depth.push_back(std::max(places.back()[1] + 2, 0.0f));
        }
        sort.sort(GlBuffer(device, places), count, camera);
        const auto order = sort.order().read<std::uint32_t>(static_cast<std::size_t>(count));
        std::vector<char> is_there(static_cast<std::size_t>(count));
        for (std::size_t k = 0; k < order.size(); ++k) {
            ASSERT_LT(order[k], order.size());
            is_there[order[k]] = 1;
            if (k == 0) continue;
            const float before = depth[order[k - 1]], here = depth[order[k]];
            ASSERT_GE(before, here * (1 - 1.6e-5f)) << count;
            // Stable.
            if (before == here) {
                ASSERT_LT(order[k - 1], order[k]) << count;
            }
        }
        EXPECT_EQ(std::accumulate(is_there.begin(), is_there.end(), 0), count);
    }
}

}  // namespace
}  // namespace gischt
