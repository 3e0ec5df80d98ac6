// SPDX-License-Identifier: Apache-2.0
// What the methods on graphics hardware share, and both methods that show media against the march
// on the processor, which they must resemble.
#include <gtest/gtest.h>

#include "base/error.h"
#include "gl/null_device.h"
#include "render/march/gpu_march.h"
#include "render/march/march.h"
#include "render/realtime/drawer.h"
#include "render/realtime/lit_volume.h"
#include "render/realtime/test_scenes.h"
#include "render/slices/slices.h"

namespace gischt {
namespace {

SphereSurface ball(const Vec3d& center, double radius) {
    SphereSurface s;
    s.center = Keyed<Vec3d>(center);
    s.radius = Keyed<double>(radius);
    return s;
}
GroundSurface floor_at(double z) {
    GroundSurface g;
    g.point = Keyed<Vec3d>(Vec3d(0, 0, z));
    return g;
}

struct Case {
    std::string name;
    View view;
    double rms = 0.03;  // allowed, over the mean
    LightGridMethod light = LightGridMethod::Sweep;
};

View grey_view() {
    return test_view({test_cloud(48, test_medium(Vec3d(12.0), 0.9, 0.5))});
}

std::vector<Case> cases() {
    std::vector<Case> list;
    list.push_back({"grey", grey_view()});
    list.push_back({"colored", test_view({test_cloud(48, test_medium({4, 8, 16}))})});
    MediumParams glowing = test_medium(Vec3d(8.0), 0.3);
    glowing.emission = EmissionKind::Blackbody;
    glowing.emission_scale = Keyed<double>(1e-4);
    list.push_back({"glowing", test_view({test_cloud(48, glowing)})});
    MediumParams rayleigh = test_medium({10, 5, 5});
    rayleigh.phase = PhaseKind::Rayleigh;
    list.push_back(
        {"two media", test_view({test_cloud(48, test_medium(Vec3d(8.0), 0.9, 0.3), {-0.2, 0, 0}),
                                 test_cloud(48, rayleigh, {0.3, 0.1, 0.1})})});
    View lamps = test_view({test_cloud(48, test_medium(Vec3d(6.0)))});
    lamps.lights = {std::make_shared<PointLight>(Vec3d(0.9, -0.6, 0.8), Vec3f(2, 1, 1)),
                    std::make_shared<SpotLight>(Vec3d(-1, -1, 0), normalize(Vec3d(1, 1, 0)),
                                                Vec3f(0, 0, 8), 0.2, 0.4)};
    list.push_back({"lamps", lamps});
    View octaves = grey_view();
    MediumParams many = test_medium(Vec3d(20.0), 0.99, 0.4);
    many.multiple_scattering.octaves = 3;
    octaves.media = {test_cloud(48, many)};
    list.push_back({"octaves", octaves});
    View solids = grey_view();
    solids.surfaces = SurfaceSet({ball({0.15, -0.25, 0}, 0.2), floor_at(-0.4)}, 0);
    solids.lights.push_back(std::make_shared<PointLight>(Vec3d(0, 0, 1.5), Vec3f(1)));
    // Edges of shadows lie between cells.
    list.push_back({"solids", solids, 0.06});
    View parallel = grey_view();
    CameraParams camera;
    camera.projection = Projection::Orthographic;
    camera.position = Keyed<Vec3d>(Vec3d(3, 1, 1));
    camera.target = Keyed<Vec3d>(Vec3d(0));
    camera.height = Keyed<double>(1.2);
    parallel.camera = Camera(camera, 0, 96, 72);
    list.push_back({"parallel rays", parallel});
    // With even scattering: the phase function is that of the centres of the cells, which near the
    // eye lie in all directions. With exact light: in the deep shadow there the sweep's smear makes
    // 3 %.
    View within = test_view({test_cloud(48, test_medium(Vec3d(12.0)))});
    within.camera = test_camera({0.05, -0.1, 0.02}, 96, 72, 80);
    list.push_back({"from within", within, 0.05, LightGridMethod::Exact});
    return list;
}

// Means within 5 % for slices and 2 % for the march on graphics hardware; the root mean square of
// the differences, over the mean, within what the case allows.
TEST(Realtime, ResemblesTheMarchOnTheProcessor) {
    for (const Case& c : cases()) {
        Job job;
        const RenderSettings settings = test_settings(8);
        const Image truth = make_march_method({})->render(c.view, settings, job).image;
        SlicesParams slices_params;
        GpuMarchParams march_params;
        slices_params.grid.light = march_params.grid.light = c.light;
        const Image slices = make_slices_method(slices_params)->render(c.view, settings, job).image;
        const Image march =
            make_gpu_march_method(march_params)->render(c.view, settings, job).image;
        const Comparison s = compared(slices, truth), m = compared(march, truth);
        EXPECT_NEAR(s.ratio(), 1, 0.05) << c.name;
        EXPECT_NEAR(m.ratio(), 1, 0.02) << c.name;
        EXPECT_LT(s.relative_rms(), c.rms) << c.name << " slices";
        EXPECT_LT(m.relative_rms(), c.rms) << c.name << " march";
        std::cout << c.name << ": slices " << s.ratio() << " rms " << s.relative_rms() << ", march "
                  << m.ratio() << " rms " << m.relative_rms() << "\n";
    }
}

// The light of the sky is taken as if it were scattered evenly: exact where it is.
TEST(Realtime, TakesTheLightOfTheSky) {
    View view = grey_view();
    view.media = {test_cloud(48, test_medium(Vec3d(8.0)))};
    view.lights = {std::make_shared<ConstantLight>(Vec3f(1, 2, 3))};
    Job job;
    const Image truth = make_march_method({})->render(view, test_settings(4), job).image;
    const Image march = make_gpu_march_method({})->render(view, test_settings(4), job).image;
    EXPECT_NEAR(compared(march, truth).ratio(), 1, 0.02);
}

// A box that only absorbs, seen along its axes and across: Beer and Lambert.
TEST(Realtime, AbsorbsLikeBeerAndLambert) {
    View view = test_view({std::make_shared<const Medium>(Region::box({Vec3d(-0.5), Vec3d(0.5)}),
                                                          test_medium({1, 2, 3}, 0), 0)});
    view.background = Vec3f(1);
    SlicesParams slices;
    GpuMarchParams march;
    slices.grid.resolution = march.grid.resolution = 24;
    for (const Vec3d& eye : {Vec3d(0, -6, 0), Vec3d(6, 0, 0), Vec3d(0.01, 0, 6)}) {
        view.camera = test_camera(eye, 5, 5, 4);
        Job job;
        for (const bool is_march : {false, true}) {
            const Image image =
                (is_march ? make_gpu_march_method(march) : make_slices_method(slices))
                    ->render(view, test_settings(1), job)
                    .image;
            const auto rgb = image.color();
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_NEAR(rgb[c][12], std::exp(-1.0 - static_cast<double>(c)), 2e-3);
            }
        }
    }
}

// Depth, coverage and the background's are those of the march.
TEST(Realtime, KnowsDepthAndCoverage) {
    View view = grey_view();
    view.background.reset();
    view.surfaces = SurfaceSet({ball({0.15, -0.25, 0}, 0.2)}, 0);
    Job job;
    const RenderSettings settings = test_settings(1);
    const Image truth = make_march_method({})->render(view, settings, job).image;
    for (const bool is_march : {false, true}) {
        const Image image = (is_march ? make_gpu_march_method({}) : make_slices_method({}))
                                ->render(view, settings, job)
                                .image;
        const auto a = image.channel("A"), z = image.channel("Z");
        const auto true_a = truth.channel("A"), true_z = truth.channel("Z");
        double coverage = 0, distance = 0;
        int seen = 0, empty = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            coverage += static_cast<double>(std::abs(a[i] - true_a[i]));
            if (true_a[i] == 0) {
                EXPECT_LT(a[i], 0.005f);
                EXPECT_TRUE(std::isinf(z[i]));
                ++empty;
            }
            if (true_a[i] > 0.5f && a[i] > 0.5f) {
                distance += static_cast<double>(std::abs(z[i] - true_z[i]));
                ++seen;
            }
        }
        ASSERT_GT(seen, 500);
        ASSERT_GT(empty, 500);
        EXPECT_LT(coverage / static_cast<double>(a.size()), 0.005);
        EXPECT_LT(distance / seen, 0.01);  // m, half a cell
    }
}

TEST(Realtime, ProjectsAsTheCameraDoes) {
    CameraParams params;
    params.position = Keyed<Vec3d>(Vec3d(100, -3, 1));
    params.target = Keyed<Vec3d>(Vec3d(101, 2, 0.5));
    params.roll_degrees = Keyed<double>(20);
    const Vec3d origin(101, 1, 0.7);
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        params.projection = projection;
        const Camera camera(params, 0, 64, 48);
        const GlCamera gl(camera, origin, 2, {0.25, -0.125});
        for (const Vec3d& p : {Vec3d(101, 1, 0.7), Vec3d(100.4, 1.5, 1.2), Vec3d(101.8, 0.2, 0)}) {
            const Vec3f q(p - origin);
            float clip[4];
            for (std::size_t r = 0; r < 4; ++r) {
                clip[r] = gl.view_projection[r] * q.x + gl.view_projection[4 + r] * q.y +
                          gl.view_projection[8 + r] * q.z + gl.view_projection[12 + r];
            }
            const auto expected = camera.project(p);
            ASSERT_TRUE(expected);
            EXPECT_NEAR((clip[0] / clip[3] + 1) * 32, expected->x - 0.25, 1e-3);
            EXPECT_NEAR((1 - clip[1] / clip[3]) * 24, expected->y + 0.125, 1e-3);
            const double z = dot(p - camera.position(), camera.forward());
            const double depth = projection == Projection::Perspective
                                     ? static_cast<double>(gl.near) / z
                                     : 1 - z / static_cast<double>(gl.far);
            EXPECT_NEAR(clip[2] / clip[3], depth, 1e-5);
        }
    }
}

// Without even phase functions the source depends on the camera, the light does not.
TEST(Realtime, ShadesAnewOnlyWhatTheCameraChanges) {
    for (const double g : {0.0, 0.5}) {
        NullDevice device;
        Job job;
        const View view = test_view({test_cloud(16, test_medium(Vec3d(8.0), 0.9, g))});
        const LitGrid grid(view, {}, "test", job);
        EXPECT_TRUE(grid.holds_for(view));
        View other = view;
        other.camera = test_camera({0, 3, 0});
        EXPECT_TRUE(grid.holds_for(other));
        other.lights.push_back(test_sun({0, 0, 1}));
        EXPECT_FALSE(grid.holds_for(other));
        View solid = view;
        solid.surfaces = SurfaceSet({ball({0, 0, 0}, 0.1)}, 0);
        EXPECT_FALSE(grid.holds_for(solid));
        const LitGrid shadowed(solid, {}, "test", job);
        View copy = solid;
        copy.camera = test_camera({0, 3, 0});
        EXPECT_TRUE(shadowed.holds_for(copy));
        copy.surfaces = SurfaceSet({ball({0, 0, 0}, 0.1)}, 0);
        EXPECT_FALSE(shadowed.holds_for(copy));
        EXPECT_FALSE(shadowed.holds_for(view));

        LitVolume volume(device);
        volume.upload(grid);
        const auto dispatches = [&] {
            return std::count_if(device.calls.begin(), device.calls.end(),
                                 [](const auto& call) { return call.starts_with("dispatch"); });
        };
        const GlCamera first(view.camera, volume.origin(), volume.reach());
        const GlCamera second(test_camera({0, 3, 0}), volume.origin(), volume.reach());
        volume.shade(first);
        EXPECT_EQ(dispatches(), 2);
        volume.shade(first);
        EXPECT_EQ(dispatches(), 2);
        volume.shade(second);
        EXPECT_EQ(dispatches(), g == 0 ? 2 : 4);
    }
}

TEST(Realtime, SaysWhatItCannotShow) {
    Job job;
    View view = grey_view();
    RenderSettings settings = test_settings(1);
    settings.depth = 2;
    EXPECT_THROW(make_slices_method({})->render(view, settings, job), Error);
    settings.depth = 1;
    settings.first_sample = 3;
    EXPECT_THROW(make_gpu_march_method({})->render(view, settings, job), Error);
    settings.first_sample = 0;
    view.media = {std::make_shared<const Medium>(Region::everywhere(), test_medium(Vec3d(1.0)), 0)};
    EXPECT_THROW(make_slices_method({})->render(view, settings, job), Error);
    SphereSurface glass = ball({0, 0, 0}, 0.1);
    glass.material.kind = MaterialKind::Dielectric;
    view = grey_view();
    view.surfaces = SurfaceSet({glass}, 0);
    EXPECT_THROW(make_gpu_march_method({})->render(view, settings, job), Error);
}

TEST(Realtime, ShowsTheBackgroundWhereThereIsNothing) {
    View view = test_view({});
    Job job;
    for (const bool is_march : {false, true}) {
        const Image image = (is_march ? make_gpu_march_method({}) : make_slices_method({}))
                                ->render(view, test_settings(1), job)
                                .image;
        for (const float v : image.channel("G")) ASSERT_EQ(v, 0.2f);
    }
}

}  // namespace
}  // namespace gischt
