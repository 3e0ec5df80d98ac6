// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"
#include "gl/null_device.h"
#include "render/march/march.h"
#include "render/realtime/test_scenes.h"
#include "render/slices/half_angle_planes.h"
#include "render/slices/slice_drawer.h"
#include "render/slices/slices.h"

namespace gischt {
namespace {

SlicesParams half_angle() {
    SlicesParams params;
    params.kind = SliceKind::HalfAngle;
    params.light_pixels = 96;  // two to a cell
    return params;
}

// The eye of test_view().
const Vec3d eye_place{1.5, -2, 0.7};

Image drawn(const View& view, const SlicesParams& params, int samples = 4) {
    Job job;
    return make_slices_method(params)->render(view, test_settings(samples), job).image;
}

struct Case {
    std::string name;
    View view;
    double rms = 0.03;  // allowed, over the mean
};

View lit_from(const Vec3d& towards, const MediumParams& medium) {
    View view = test_view({test_cloud(48, medium)});
    view.lights = {test_sun(towards)};
    return view;
}

std::vector<Case> cases() {
    std::vector<Case> list;
    const MediumParams grey = test_medium(Vec3d(12.0), 0.9, 0.5);
    list.push_back({"in front", lit_from({1, -1, 2}, grey)});
    list.push_back({"behind the eye", lit_from(eye_place, grey)});
    list.push_back({"from the side", lit_from({2, 1.5, 0.2}, grey)});
    list.push_back({"behind", lit_from({-1, 2, 1}, grey)});
    list.push_back({"against the eye", lit_from(-1.0 * eye_place, grey)});
    const MediumParams colored = test_medium({4, 8, 16});
    list.push_back({"colored, in front", lit_from({1, -1, 2}, colored)});
    list.push_back({"colored, behind", lit_from({-1, 2, 1}, colored)});

    MediumParams rayleigh = test_medium({10, 5, 5});
    rayleigh.phase = PhaseKind::Rayleigh;
    View media = test_view({test_cloud(48, test_medium(Vec3d(8.0), 0.9, 0.3), {-0.2, 0, 0}),
                            test_cloud(48, rayleigh, {0.3, 0.1, 0.1})});
    list.push_back({"two media", media});

    View lamps = test_view({test_cloud(48, test_medium(Vec3d(6.0)))});
    lamps.lights = {std::make_shared<PointLight>(Vec3d(1.3, -1, 1), Vec3f(4, 2, 2)),
                    std::make_shared<SpotLight>(Vec3d(-1, -1, 0), normalize(Vec3d(1, 1, 0)),
                                                Vec3f(0, 0, 8), 0.2, 0.4)};
    list.push_back({"lamps", lamps});

    View solids = lit_from({1, -1, 2}, grey);
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(0.15, -0.25, 0));
    ball.radius = Keyed<double>(0.2);
    solids.surfaces = SurfaceSet({ball}, 0);
    list.push_back({"solids", solids, 0.04});

    View parallel = lit_from({-1, 2, 1}, grey);
    CameraParams camera;
    camera.projection = Projection::Orthographic;
    camera.position = Keyed<Vec3d>(Vec3d(3, 1, 1));
    camera.target = Keyed<Vec3d>(Vec3d(0));
    camera.height = Keyed<double>(1.2);
    parallel.camera = Camera(camera, 0, 96, 72);
    list.push_back({"parallel rays", parallel});
    return list;
}

// Means within 1 %, the light before and behind the media. The differences of pixels are most where
// forward scattering lights the rim, seen against the sun, and at the edges of surfaces' shadows.
TEST(HalfAngle, ResemblesTheMarchOnTheProcessor) {
    for (const Case& c : cases()) {
        Job job;
        const Image truth = make_march_method({})->render(c.view, test_settings(4), job).image;
        const Comparison s = compared(drawn(c.view, half_angle()), truth);
        EXPECT_NEAR(s.ratio(), 1, 0.01) << c.name;
        EXPECT_LT(s.relative_rms(), c.rms) << c.name;
        std::cout << c.name << ": " << s.ratio() << " rms " << s.relative_rms() << "\n";
    }
}

// Coverage and depth do not depend on how the slices lie, nor on the order in which they come.
TEST(HalfAngle, CoversWhatAxisSlicesCover) {
    for (const Vec3d& sun : {Vec3d(1, -1, 2), Vec3d(-1, 2, 1)}) {
        View view = lit_from(sun, test_medium(Vec3d(8.0)));
        view.background.reset();
        const Image a = drawn(view, half_angle()), b = drawn(view, {});
        const auto coverage = a.channel("A"), other = b.channel("A");
        const auto z = a.channel("Z"), other_z = b.channel("Z");
        int seen = 0;
        for (std::size_t i = 0; i < coverage.size(); ++i) {
            EXPECT_NEAR(coverage[i], other[i], 0.02);
            if (other[i] < 0.5f) continue;
            ++seen;
            EXPECT_NEAR(z[i], other_z[i], 0.03);
        }
        EXPECT_GT(seen, 100);
    }
}

// The opacity, for eye and light, is corrected for the distance of the slices.
TEST(HalfAngle, DoesNotDependOnTheSlicesDistance) {
    for (const Vec3d& sun : {Vec3d(1, -1, 2), Vec3d(-1, 2, 1)}) {
        const View view = lit_from(sun, test_medium(Vec3d(8.0)));
        SlicesParams params = half_angle();
        const Image normal = drawn(view, params, 4);
        for (const double spacing : {0.5, 2.0}) {
            params.spacing = spacing;
            const Comparison c = compared(drawn(view, params, 4), normal);
            EXPECT_NEAR(c.ratio(), 1, 0.01) << spacing;
            EXPECT_LT(c.relative_rms(), 0.02) << spacing;
        }
    }
}

// Light and eye see the planes in the same order, or in opposite ones.
TEST(HalfAngle, PlanesComeInOrder) {
    const Vec3d half(0.5, 0.4, 0.3);
    for (int i = 0; i < 200; ++i) {
        const double u = 2 * pi * 0.618 * i;
        const Vec3d place = 2.0 * normalize(Vec3d(std::cos(u), std::sin(u), 0.01 * i - 1));
        const SeenFrom eye{{1.5, -2, 0.7}, false}, light{place, i % 2 == 0};
        const HalfAnglePlanes p = half_angle_planes(half, Vec3d(0.05), 1, 0.5, eye, light);
        EXPECT_EQ(p.is_front_to_back, dot(eye.place, place) >= 0);
        EXPECT_LT(p.step, 0);
        EXPECT_LE(-p.step, 0.05 + 1e-9);
        EXPECT_NEAR(p.first + (p.count - 1) * p.step, -p.first, 1e-9);
        // Half an angle of at most 90 degrees lies between the normal and both.
        EXPECT_GE(dot(p.across, normalize(light.place)), std::sqrt(0.5) - 1e-9);
        EXPECT_GE(std::abs(dot(p.across, normalize(eye.place))), std::sqrt(0.5) - 1e-9);
    }
}

// All corners of the box lie in the light's picture, and one touches its edge.
TEST(HalfAngle, LightSeesAllOfTheBox) {
    const Vec3d half(0.5, 0.4, 0.3);
    for (const bool is_infinite : {false, true}) {
        const GlMatrix m = light_projection(half, {Vec3d(0.6, -0.8, 0.7), is_infinite});
        double most = 0;
        for (int i = 0; i < 8; ++i) {
            const Vec3d c = half * Vec3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
            const auto row = [&](std::size_t r) {
                return static_cast<double>(m[r]) * c.x + static_cast<double>(m[4 + r]) * c.y +
                       static_cast<double>(m[8 + r]) * c.z + static_cast<double>(m[12 + r]);
            };
            EXPECT_GT(row(3), 0);
            most = std::max({most, std::abs(row(0) / row(3)), std::abs(row(1) / row(3))});
        }
        EXPECT_NEAR(most, 1, 1e-5);
    }
}

// For each slice the light's buffer is read before it is dimmed.
TEST(HalfAngle, ReadsTheLightBeforeItDimsIt) {
    NullDevice device;
    SliceDrawer drawer(device, half_angle());
    const View view = test_view({test_cloud(16, test_medium(Vec3d(8.0)))});
    Job job;
    drawer.upload(view, job);
    OpaqueLayer layer(device);
    layer.upload(OpaquePainter(view, drawer.grid()).paint(view.camera, {}, {}, job));
    const GlFramebuffer target(device, {96, 72});
    device.draws.clear();
    drawer.draw({view.camera, {0, 0}, 0.5f, false}, layer, target);
    ASSERT_GT(device.draws.size(), 2u + 2 * 16);
    ASSERT_EQ(device.draws.size() % 2, 0u);
    for (std::size_t i = 1; i + 1 < device.draws.size(); i += 2) {
        EXPECT_EQ(device.draws[i].blend->destination, BlendFactor::One);
        EXPECT_EQ(device.draws[i + 1].blend->destination, BlendFactor::SrcColor);
    }
}

// What it cannot show is refused with the way out, and each of these the axis slices show.
TEST(HalfAngle, RefusesByName) {
    const auto message = [](const View& view, const SlicesParams& params) -> std::string {
        try {
            drawn(view, params, 1);
        } catch (const Error& e) {
            EXPECT_NE(e.hint().find("axis"), std::string::npos);
            return e.what();
        }
        return "";
    };
    const auto expect = [&](const View& view, SlicesParams params, const char* word) {
        params.kind = SliceKind::HalfAngle;
        EXPECT_NE(message(view, params).find(word), std::string::npos) << word;
        params.kind = SliceKind::Axis;
        EXPECT_NO_THROW(drawn(view, params, 1)) << word;
    };
    const auto cloud = test_cloud(16, test_medium(Vec3d(8.0)));
    SlicesParams vertex;
    vertex.sampling = SliceSampling::Vertex;
    expect(test_view({cloud}), vertex, "meshes");
    View dark = test_view({cloud});
    dark.lights = {};
    expect(dark, {}, "sun, point or spot");
    MediumParams many = test_medium(Vec3d(8.0));
    many.multiple_scattering.octaves = 3;
    expect(test_view({test_cloud(16, many)}), {}, "octaves");
    View within = test_view({cloud});
    within.camera = test_camera({0.1, 0.1, 0});
    expect(within, {}, "the eye");
    View lamp = test_view({cloud});
    lamp.lights = {std::make_shared<PointLight>(Vec3d(0.1, 0, 0.2), Vec3f(1))};
    expect(lamp, {}, "the light");
}

}  // namespace
}  // namespace gischt
