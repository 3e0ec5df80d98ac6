// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "gl/null_device.h"
#include "render/realtime/test_scenes.h"
#include "render/slices/slice_drawer.h"
#include "render/slices/slice_stack.h"
#include "render/slices/slices.h"

namespace gischt {
namespace {

Vec3d on_orbit(double turn, double height) {
    return {std::cos(2 * pi * turn), std::sin(2 * pi * turn), height};
}

TEST(SliceStack, IsThatOfTheLargestCosine) {
    for (int i = 0; i < 400; ++i) {
        const Vec3d d = on_orbit(i / 400.0, 0.01 * (i % 37) - 0.2);
        const auto sharp = stack_shares(d, 0), soft = stack_shares(d, 0.1);
        double sum = 0;
        std::size_t best = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            if (sharp[a] > sharp[best]) best = a;
            sum += soft[a];
        }
        EXPECT_EQ(std::abs(d[static_cast<int>(best)]), max_component(abs(d)));
        EXPECT_NEAR(sum, 1, 1e-12);
        // Away from a switch both are the same.
        const Vec3d c = abs(normalize(d));
        const double most = max_component(c), sum_c = c.x + c.y + c.z;
        const double second = sum_c - most - min_component(c);
        if (most - second > 0.1) {
            EXPECT_EQ(soft[best], 1);
        } else {
            EXPECT_LT(soft[best], 1);
        }
    }
}

// The shares change by at most 2/fade of the change in direction.
TEST(SliceStack, FadesContinuously) {
    constexpr int steps = 5000;
    for (const double height : {0.0, 0.3, 0.7, 1.0}) {
        auto before = stack_shares(on_orbit(0, height), 0.1);
        for (int i = 1; i <= steps; ++i) {
            const auto now = stack_shares(on_orbit(static_cast<double>(i) / steps, height), 0.1);
            for (std::size_t a = 0; a < 3; ++a) {
                EXPECT_LT(std::abs(now[a] - before[a]), 20 * 2 * pi / steps);
            }
            before = now;
        }
    }
}

TEST(SliceStack, ComesFromBackToFront) {
    for (const double eye : {-5.0, -0.3, 0.0, 0.26, 3.0}) {
        int count = 0;
        for (const SliceRun& run : slice_runs(-1, 1, 8, 0.5, eye)) {
            double before = std::numeric_limits<double>::infinity();
            for (int i = 0; i < run.count; ++i, ++count) {
                const double distance = std::abs(run.first + i * run.step - eye);
                EXPECT_LT(distance, before);
                before = distance;
            }
        }
        EXPECT_EQ(count, 8);
    }
    const auto run = slice_runs(-1, 1, 4, 0.5, -std::numeric_limits<double>::infinity());
    ASSERT_EQ(run.size(), 1u);
    EXPECT_EQ(run[0].first, 0.75);
}

// The picture of the middle of the cloud while the camera goes once around it.
class Orbit {
  public:
    explicit Orbit(double fade) : drawer_(offscreen_device(), params(fade)) {
        view_ = test_view({test_cloud(32, test_medium(Vec3d(10.0)))});
        Job job;
        drawer_.upload(view_, job);
    }
    std::vector<float> frame(double turn, double height) {
        view_.camera = test_camera(3.0 * normalize(on_orbit(turn, height)), 48, 36, 26);
        OpaqueLayer layer(offscreen_device());
        Job job;
        layer.upload(
            OpaquePainter(view_, drawer_.grid()).paint(view_.camera, {0, 0}, {0.5f, 0.5f}, job));
        const GlFramebuffer target(offscreen_device(), {48, 36});
        drawer_.draw({view_.camera, {0, 0}, 0.5f, false}, layer, target);
        return target.read();
    }
    static double difference(const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            sum += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
        }
        return std::sqrt(sum / static_cast<double>(a.size()));
    }

  private:
    static SlicesParams params(double fade) {
        SlicesParams p;
        p.fade = fade;
        return p;
    }
    SliceDrawer drawer_;
    View view_;
};

// Over a full orbit in half degrees no frame differs from the one before by more than 1.6 times the
// median difference, which is the motion itself.
TEST(Slices, OrbitWithoutAJump) {
    constexpr int steps = 720;
    Orbit orbit(0.1);
    std::vector<double> jumps;
    std::vector<float> before = orbit.frame(0, 0.3);
    for (int i = 1; i <= steps; ++i) {
        std::vector<float> now = orbit.frame(static_cast<double>(i) / steps, 0.3);
        jumps.push_back(Orbit::difference(now, before));
        before = std::move(now);
    }
    std::vector<double> sorted = jumps;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_LT(sorted.back(), 1.6 * sorted[steps / 2]);
    std::cout << "orbit: median " << sorted[steps / 2] << ", largest " << sorted.back() << "\n";
}

// A step of a hundredth of a degree across the switch: without the fade the picture jumps, with it
// the change is that of the motion.
TEST(Slices, FadesWhereItWouldJump) {
    const double d = 0.005 / 360;
    Orbit sharp(0), soft(0.1);
    const double jump = Orbit::difference(sharp.frame(0.125 - d, 0), sharp.frame(0.125 + d, 0));
    const double step = Orbit::difference(soft.frame(0.125 - d, 0), soft.frame(0.125 + d, 0));
    const double motion = Orbit::difference(soft.frame(0.06 - d, 0), soft.frame(0.06 + d, 0));
    EXPECT_GT(jump, 5 * step);
    EXPECT_LT(step, 4 * motion);
    std::cout << "switch: " << jump << ", faded " << step << ", motion " << motion << "\n";
}

// The classical way, colours at the corners of meshes, shows the same.
TEST(Slices, VerticesShowWhatTexturesShow) {
    const View view = test_view({test_cloud(48, test_medium({6, 9, 12}, 0.9, 0.3))});
    Job job;
    SlicesParams params;
    const Image texture = make_slices_method(params)->render(view, test_settings(1), job).image;
    params.sampling = SliceSampling::Vertex;
    const Image vertex = make_slices_method(params)->render(view, test_settings(1), job).image;
    const Comparison c = compared(vertex, texture);
    EXPECT_NEAR(c.ratio(), 1, 0.01);
    EXPECT_LT(c.relative_rms(), 0.02);
}

// The opacity is corrected for the distance of the slices.
TEST(Slices, DoNotDependOnTheirDistance) {
    const View view = test_view({test_cloud(48, test_medium(Vec3d(8.0)))});
    Job job;
    SlicesParams params;
    const Image normal = make_slices_method(params)->render(view, test_settings(4), job).image;
    for (const double spacing : {0.5, 2.0}) {
        params.spacing = spacing;
        const Image other = make_slices_method(params)->render(view, test_settings(4), job).image;
        EXPECT_NEAR(compared(other, normal).ratio(), 1, 0.01) << spacing;
        EXPECT_LT(compared(other, normal).relative_rms(), 0.02) << spacing;
    }
}

// One stack is one draw with as many slices as layers, or two where the eye is among them; near a
// switch there are two stacks, each into a framebuffer of its own, and two draws that mix them.
TEST(Slices, DrawsWhatTheDirectionAsksFor) {
    NullDevice device;
    SliceDrawer drawer(device, {});
    View view = test_view({test_cloud(16, test_medium(Vec3d(8.0)))});
    Job job;
    drawer.upload(view, job);
    OpaqueLayer layer(device);
    layer.upload(OpaquePainter(view, drawer.grid()).paint(view.camera, {}, {}, job));
    const GlFramebuffer target(device, {96, 72});
    const auto draws = [&](const Vec3d& eye) {
        device.draws.clear();
        drawer.draw({test_camera(eye), {0, 0}, 0.5f, false}, layer, target);
        return device.draws;
    };
    const auto straight = draws({4, 0.5, 0.5});
    ASSERT_EQ(straight.size(), 2u);
    EXPECT_EQ(straight[1].instances, drawer.light().cells().x);
    EXPECT_EQ(straight[1].blend->destination, BlendFactor::OneMinusSrcAlpha);
    EXPECT_EQ(straight[1].depth, GlDepth::Off);
    EXPECT_EQ(draws({0.1, 0.02, 0.03}).size(), 3u);

    const auto mixed = draws({4, 4, 0.5});
    ASSERT_EQ(mixed.size(), 1u + 2 * 3);
    EXPECT_EQ(mixed[3].blend->source, BlendFactor::ConstantColor);
    EXPECT_EQ(mixed[3].blend->destination, BlendFactor::Zero);
    EXPECT_EQ(mixed[6].blend->destination, BlendFactor::One);
    EXPECT_NEAR(mixed[3].blend->constant[0] + mixed[6].blend->constant[0], 1, 1e-6);
}

}  // namespace
}  // namespace gischt
