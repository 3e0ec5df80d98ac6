// SPDX-License-Identifier: Apache-2.0
#include "render/march/march.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "math/noise.h"
#include "math/quadrature.h"
#include "optics/environment.h"
#include "optics/local_lights.h"
#include "optics/surface_params.h"
#include "render/march/ray_march.h"
#include "render/march/sky_directions.h"

namespace gischt {
namespace {

using MediumPtr = std::shared_ptr<const Medium>;

MediumParams coefficients(const Vec3d& absorption, const Vec3d& scattering, double g = 0) {
    MediumParams p;
    p.absorption = Keyed<Vec3d>(absorption);
    p.scattering = Keyed<Vec3d>(scattering);
    p.g = Keyed<double>(g);
    return p;
}

MediumPtr solid(const Region& region, const MediumParams& params, double kelvin = 0) {
    return std::make_shared<const Medium>(region, params, 0, kelvin);
}

constexpr int cells = 32;

// A cloud of soft lumps in [-1,1]^3; `map` takes a point before the noise is asked.
MediumPtr cloud(const MediumParams& params, const Transform& map = {}) {
    Frame frame;
    Field& f = frame.fields["density"];
    f.component.emplace_back(TileMap::box(Vec3i(cells)));
    f.to_world = Transform::scale_translate(2.0 / cells, Vec3d(-1));
    for (int i = 0; i < cells * cells * cells; ++i) {
        const Vec3i c(i % cells, i / cells % cells, i / cells / cells);
        const Vec3d p = map.point(f.to_world.point(Vec3d(c) + Vec3d(0.5)));
        const double lump = 0.9 - length(p) + 0.5 * static_cast<double>(gradient_noise(2.5 * p, 7));
        f.component[0].ref(c) = static_cast<float>(std::clamp(2 * lump, 0.0, 1.0));
    }
    // A colour, for who asks for it: half of the red, all of the rest.
    Field dye = f;
    dye.component.resize(3, dye.component[0]);
    for (std::size_t a = 0; a < 3; ++a) std::ranges::fill(dye.component[a].values(), a ? 1 : 0.5f);
    frame.fields.emplace("dye", dye);
    Job job;
    return std::make_shared<const Medium>(frame, params, 0, job);
}

// An orthographic camera that looks along +y at [-1,1]^2 of x and z.
View view_of(std::vector<MediumPtr> media, int size = 32) {
    CameraParams camera;
    camera.projection = Projection::Orthographic;
    camera.position = Keyed<Vec3d>(Vec3d(0, -4, 0));
    camera.target = Keyed<Vec3d>(Vec3d(0, 0, 0));
    camera.height = Keyed<double>(2.0);
    View view;
    view.camera = Camera(camera, 0, size, size);
    view.media = std::move(media);
    return view;
}

RenderResult render(const View& view, const MarchParams& params = {}, int samples = 1) {
    Job job;
    RenderSettings settings;
    settings.samples_per_pixel = samples;
    settings.filter = FilterKind::Box;
    return make_march_method(params)->render(view, settings, job);
}

double mean(const Image& image, std::string_view channel = "G") {
    double sum = 0;
    for (const float v : image.channel(channel)) sum += static_cast<double>(v);
    return sum / static_cast<double>(image.pixel_count());
}

double rms(const Image& a, const Image& b) {
    double sum = 0;
    const auto x = a.channel("G"), y = b.channel("G");
    for (std::size_t i = 0; i < x.size(); ++i) {
        sum += std::pow(static_cast<double>(x[i]) - static_cast<double>(y[i]), 2);
    }
    return std::sqrt(sum / static_cast<double>(x.size()));
}

// Radiance of one ray, the mean over many jitters.
Vec3d radiance(const View& view, const MarchParams& params, const Ray& ray, int samples = 64) {
    Job job;
    const MarchScene scene(view, params, job);
    RayMarcher marcher(scene);
    Vec3d sum;
    for (int s = 0; s < samples; ++s) {
        sum +=
            Vec3d(marcher(ray, PixelSampler(5, 1, 0, 0, static_cast<std::uint32_t>(s))).radiance);
    }
    return sum / Vec3d(samples);
}

LightPtr sun(const Vec3d& towards, float irradiance = 3) {
    return std::make_shared<SunLight>(normalize(towards), Vec3f(irradiance), 0);
}
LightPtr sky(const Vec3f& radiance) {
    return std::make_shared<ConstantLight>(radiance);
}

TEST(March, AbsorbsLikeBeerAndLambert) {
    for (const auto& [tau, expected] : {std::pair{1.0, 0.528482}, std::pair{5.0, 0.076766}}) {
        View view = view_of({solid(Region::sphere({}, 1), coefficients(Vec3d(tau / 2), {}))}, 64);
        view.lights = {sky({1, 1, 1})};
        const RenderResult r = render(view, {}, 16);
        // The disc covers pi/4 of the picture, the sky the rest.
        EXPECT_NEAR(mean(r.image), 1 - pi / 4 * (1 - expected), 1.5e-3);
    }
}

TEST(March, GlowsAndAbsorbsAtOnce) {
    MediumParams params = coefficients({0.5, 1, 2}, {});
    params.emission = EmissionKind::Blackbody;
    View view = view_of({solid(Region::box({Vec3d(-1), Vec3d(1)}), params, 3000)}, 4);
    const Vec3f glow = blackbody_radiance(3000);
    const Image image = render(view).image;
    const double taus[3] = {1, 2, 4};
    for (int c = 0; c < 3; ++c) {
        // L_e (1 - exp(-tau)).
        const double expected = static_cast<double>(glow[c]) * (1 - std::exp(-taus[c]));
        EXPECT_NEAR(image.color()[static_cast<std::size_t>(c)][5] / expected, 1, 2e-4);
    }
    // Eq. 19 holds for any step: no energy is gained by coarse ones.
    MarchParams coarse;
    coarse.step = 16;
    coarse.step_depth = 100;
    EXPECT_NEAR(mean(render(view, coarse).image) / mean(image), 1, 1e-5);
}

// Integral from 0 to 10 of exp(-sigma (t + r)) / r^2 dt, r^2 = 1 + (t - 5)^2, times sigma I p.
TEST(March, ShowsTheAirlightOfAPointLight) {
    for (const auto& [sigma, integral] :
         {std::pair{1e-4, 2.74680153}, std::pair{0.1, 1.42945269}, std::pair{1.0, 0.00710817}}) {
        View view = view_of(
            {solid(Region::box({{-20, -20, 0}, {20, 20, 10}}), coefficients({}, Vec3d(sigma)))});
        view.lights = {std::make_shared<PointLight>(Vec3d(1, 0, 5), Vec3f(100))};
        const double expected = 100 * sigma * integral / (4 * pi);
        MarchParams params;
        params.step = 0.25;  // of 1/64 of the box: 16 cm, one metre from the light
        params.step_depth = 0.1;
        params.cutoff = 0;
        const double got = radiance(view, params, {{0, 0, 0}, {0, 0, 1}}).y;
        // The first one's closed form leaves out an extinction of 0.0006.
        EXPECT_NEAR(got / expected, 1, sigma < 0.01 ? 1.5e-3 : 1e-3) << sigma;
    }
}

TEST(March, TransmitsASlabAtAnyStep) {
    for (const double step : {16.0, 1.0, 0.1}) {
        for (const double step_depth : {100.0, 0.5}) {
            MarchParams params;
            params.step = step;
            params.step_depth = step_depth;
            params.cutoff = 0;
            View view = view_of(
                {solid(Region::box({Vec3d(-1), Vec3d(1)}), coefficients({1, 2, 3}, {}))}, 4);
            view.lights = {sky({1, 1, 1})};
            const Image image = render(view, params).image;
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(image.color()[static_cast<std::size_t>(c)][3], std::exp(-2.0 * (c + 1)),
                            2e-6);
            }
        }
    }
}

// Single scattering of a sun in a slab, where the light comes from the camera's side: s E p times
// the integral of exp(-2 e t).
TEST(March, HasTheSingleScatteringOfASlabAtAnyStep) {
    View view =
        view_of({solid(Region::box({Vec3d(-1), Vec3d(1)}), coefficients(Vec3d(0.5), Vec3d(1)))}, 4);
    view.lights = {sun({0, -1, 0})};
    const double expected = 3 / (4 * pi) * (1 - std::exp(-2 * 1.5 * 2)) / (2 * 1.5);
    for (const double step : {8.0, 4.0, 2.0, 1.0}) {
        MarchParams params;
        params.step = step;
        params.step_depth = 100;
        const double error =
            std::abs(radiance(view, params, {{0.1, -4, 0.2}, {0, 1, 0}}, 256).y - expected);
        // The mean over jitters is exact in an even medium.
        EXPECT_LT(error, 2e-3 * expected) << step;
    }
}

TEST(March, ConvergesOnACloud) {
    View view = view_of({cloud(coefficients(Vec3d(0.5), Vec3d(8), 0.5))}, 24);
    view.lights = {sun({0.5, -1, 1})};
    MarchParams params;
    params.light_cache = false;
    params.step = 0.125;
    params.shadow_step = 0.125;
    params.step_depth = 0.05;
    const Image fine = render(view, params).image;
    double before = 1;
    for (const double step : {2.0, 1.0, 0.5}) {
        params.step = params.shadow_step = step;
        params.step_depth = 0.5 * step;
        const double error = rms(render(view, params).image, fine) / mean(fine);
        EXPECT_LT(error, 0.8 * before) << step;
        before = error;
    }
    EXPECT_LT(before, 0.03);
}

TEST(March, GridsOfLightAgreeWithTheSecondMarch) {
    MarchParams exact, cached;
    exact.light_cache = false;
    exact.sky_samples = 8;
    for (const double g : {0.0, 0.8}) {
        const MediumPtr medium = cloud(coefficients(Vec3d(0.2), {6, 7, 8}, g));
        View view = view_of({medium}, 24);
        const std::vector<std::pair<LightPtr, double>> cases{
            {sun({0.5, -1, 1}), 0.015},
            {std::make_shared<PointLight>(Vec3d(0.8, -0.9, 0.7), Vec3f(1)), 0.03},
            {std::make_shared<PointLight>(Vec3d(0.1, 0, 0.1), Vec3f(1)), 0.04},
            {sky({1, 0.5, 0.25}), 0.05}};
        for (std::size_t i = 0; i < cases.size(); ++i) {
            view.lights = {cases[i].first};
            if (i == 3) view.background = Vec3f{};
            const Image a = render(view, exact, 4).image, b = render(view, cached, 4).image;
            EXPECT_LT(rms(a, b) / mean(a), cases[i].second) << g << " light " << i;
            EXPECT_NEAR(mean(b) / mean(a), 1, i == 3 ? 0.02 : 0.01) << g << " light " << i;
        }
    }
}

// Without extinction to speak of the sky is the same from everywhere: what is scattered is its
// radiance times the optical depth, for any phase function.
TEST(March, GridOfSkyLightIsNormalised) {
    for (const double g : {0.0, 0.877, -0.5}) {
        View view = view_of({cloud(coefficients({}, Vec3d(1e-4), g))}, 8);
        view.lights = {sky({2, 2, 2})};
        view.background = Vec3f{};
        const Ray ray{{0.1, -4, 0.1}, {0, 1, 0}};
        const double depth = static_cast<double>(optical_depth(view.media, ray, {}).y);
        EXPECT_NEAR(radiance(view, {}, ray).y / (2 * depth), 1, 2e-3) << g;
    }
}

TEST(March, NeverScattersMoreThanArrives) {
    View view = view_of({cloud(coefficients({}, Vec3d(40), 0.7))}, 24);
    view.lights = {sky({1, 1, 1})};
    const Image image = render(view, {}, 4).image;
    for (const float v : image.channel("R")) {
        EXPECT_LE(v, 1.0f + 1e-3f);
        EXPECT_GE(v, 0.0f);
    }
}

TEST(March, IsTheSameOnAnyNumberOfThreads) {
    View view = view_of({cloud(coefficients(Vec3d(0.2), {6, 7, 8}, 0.3))}, 40);
    view.lights = {sun({1, -1, 2}), sky({0.1f, 0.2f, 0.3f}),
                   std::make_shared<PointLight>(Vec3d(0, -2, 0), Vec3f(2))};
    view.surfaces = SurfaceSet(
        {SphereSurface{"", Keyed<Vec3d>(Vec3d(0.7, 0, -0.6)), Keyed<double>(0.3), {}}}, 0);
    const RenderResult all = render(view, {}, 3);
    const ThreadLimit one(1);
    const RenderResult single = render(view, {}, 3);
    EXPECT_EQ(all.image, single.image);
    EXPECT_EQ(all.statistics.lookups, single.statistics.lookups);
}

// The picture of a mirrored or turned world is the mirrored or turned picture.
TEST(March, DoesNotKnowWhichWayIsUp) {
    const MediumParams params = coefficients(Vec3d(0.2), Vec3d(7), 0.4);
    const Vec3d light(0.5, -1, 0.7);
    const Ray ray{{0.13, -4, 0.21}, normalize(Vec3d(0.02, 1, -0.03))};
    View view = view_of({cloud(params)});
    view.lights = {sun(light), std::make_shared<PointLight>(light, Vec3f(1))};
    const double expected = radiance(view, {}, ray).y;
    ASSERT_GT(expected, 0.05);
    std::vector<Transform> maps(3);
    maps[0].column[0] = {-1, 0, 0};                            // mirror
    maps[1].column = {Vec3d{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};   // turn around the diagonal
    maps[2].column = {Vec3d{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};  // quarter turn around y
    for (const Transform& map : maps) {
        View turned = view_of({cloud(params, map.inverse())});
        turned.lights = {sun(map.point(light)),
                         std::make_shared<PointLight>(map.point(light), Vec3f(1))};
        const Ray turned_ray{map.point(ray.origin), map.vector(ray.direction)};
        EXPECT_NEAR(radiance(turned, {}, turned_ray).y / expected, 1, 2e-3);
    }
}

TEST(March, TwoMediaInOnePlaceAddUp) {
    View one = view_of({cloud(coefficients(Vec3d(1), Vec3d(6), 0.3))}, 16);
    const MediumPtr half = cloud(coefficients(Vec3d(0.5), Vec3d(3), 0.3));
    View two = view_of({half, half}, 16);
    one.lights = two.lights = {sun({1, -1, 1}), sky({0.2f, 0.2f, 0.2f})};
    const Image a = render(one).image, b = render(two).image;
    EXPECT_LT(rms(a, b), 3e-3 * mean(a));
}

// A colour is an albedo: half the scattering, the other half being absorbed.
TEST(March, ColorsTheScatteredLight) {
    MediumParams params = coefficients({}, Vec3d(6));
    params.color_field = "dye";
    View dyed = view_of({cloud(params)}, 12),
         mixed = view_of({cloud(coefficients({3, 0, 0}, {3, 6, 6}))}, 12);
    dyed.lights = mixed.lights = {sun({1, -1, 1}), sky({0.2f, 0.2f, 0.2f})};
    const Image a = render(dyed).image, b = render(mixed).image;
    for (const char* channel : {"R", "G", "B"}) {
        EXPECT_NEAR(mean(a, channel) / mean(b, channel), 1, 1e-4) << channel;
    }
}

TEST(March, OctavesOnlyAddLight) {
    MediumParams params = coefficients({}, Vec3d(20), 0.6);
    View view = view_of({cloud(params)}, 16);
    view.lights = {sun({1, -1, 1}), sky({0.2f, 0.2f, 0.2f})};
    view.background = Vec3f{};
    const double single = mean(render(view).image);
    params.multiple_scattering.octaves = 6;
    view.media = {cloud(params)};
    const double halving = mean(render(view).image);
    EXPECT_GT(halving, 1.2 * single);
    // The path for any attenuation agrees with the one for a half.
    MediumParams near = params;
    near.multiple_scattering.attenuation = 0.5 + 1e-6;
    view.media = {cloud(near)};
    EXPECT_NEAR(mean(render(view).image) / halving, 1, 1e-4);
}

TEST(March, ShadesSurfacesThroughTheMedium) {
    // A floor under an absorbing slab, sun and camera overhead: both ways are dimmed.
    View view;
    view.media = {solid(Region::box({{-50, -50, 1}, {50, 50, 2}}), coefficients(Vec3d(0.7), {}))};
    GroundSurface ground;
    ground.material.albedo = Vec3d(0.4);
    view.surfaces = SurfaceSet({ground}, 0);
    view.lights = {sun({0, 0, 1})};
    CameraParams camera;
    camera.projection = Projection::Orthographic;
    camera.position = Keyed<Vec3d>(Vec3d(0, 0, 5));
    camera.target = Keyed<Vec3d>(Vec3d(0, 0, 0));
    view.camera = Camera(camera, 0, 4, 4, {0, 1, 0});
    const RenderResult r = render(view, {}, 2);
    EXPECT_NEAR(mean(r.image), 0.4 / pi * 3 * std::exp(-1.4), 1e-5);
    EXPECT_EQ(r.image.channel("A")[0], 1);
    // Between the slab, at 1.5, and the floor, at 5, by opacity.
    EXPECT_GT(r.image.channel("Z")[0], 3);
    EXPECT_LT(r.image.channel("Z")[0], 5);

    // The light of the whole sky through nothing is albedo times its radiance.
    view.media.clear();
    view.lights = {sky({1, 1, 1})};
    EXPECT_NEAR(mean(render(view, {}, 8).image), 0.4, 1e-4);
}

TEST(March, SurfacesCastShadowsIntoTheMedium) {
    View view =
        view_of({solid(Region::box({Vec3d(-1), Vec3d(1)}), coefficients({}, Vec3d(0.01)))}, 8);
    view.lights = {sun({0, 0, 1})};
    const double lit = mean(render(view).image);
    // A roof over the left half.
    BoxSurface roof;
    roof.center = Keyed<Vec3d>(Vec3d(-1, 0, 1.5));
    roof.size = Vec3d(2, 4, 0.1);
    view.surfaces = SurfaceSet({roof}, 0);
    EXPECT_NEAR(mean(render(view).image) / lit, 0.5, 1e-3);
}

TEST(March, GivesCoverageAndDepth) {
    View view = view_of({solid(Region::sphere({}, 0.5), coefficients(Vec3d(1), {}))}, 32);
    view.background = std::nullopt;
    const Image image = render(view, {}, 4).image;
    const auto alpha = image.channel("A"), depth = image.channel("Z");
    EXPECT_EQ(alpha[0], 0);
    EXPECT_TRUE(std::isinf(depth[0]));
    const std::size_t middle = image.index(16, 16);
    EXPECT_NEAR(alpha[middle], 1 - std::exp(-1.0), 5e-3);
    EXPECT_NEAR(depth[middle], 4, 0.2);
}

TEST(March, SurvivesEmptyAndTransparentMedia) {
    Frame frame;
    frame.fields["density"].component.emplace_back(TileMap::box(Vec3i(16)));
    Job job;
    const auto empty = std::make_shared<const Medium>(frame, coefficients({}, Vec3d(1)), 0, job);
    View view = view_of({empty, cloud(coefficients({}, {}))}, 8);
    view.lights = {sun({1, 1, 1}), sky({0.25f, 0.5f, 0.75f}),
                   std::make_shared<PointLight>(Vec3d(0, 0, 0), Vec3f(1))};
    const Image image = render(view).image;
    for (const float v : image.channel("B")) EXPECT_FLOAT_EQ(v, 0.75f);
    view.media.clear();
    EXPECT_FLOAT_EQ(static_cast<float>(mean(render(view).image)), 0.5f);
}

TEST(March, SurvivesDegenerateRays) {
    View view = view_of({cloud(coefficients(Vec3d(1), Vec3d(5)))});
    view.lights = {sun({0, 0, 1}), sky({1, 1, 1}),
                   std::make_shared<PointLight>(Vec3d(0.03125, 0.03125, 0.03125), Vec3f(1))};
    Job job;
    const MarchScene scene(view, {}, job);
    RayMarcher marcher(scene);
    // From inside, along axes and in the faces of bricks and voxels.
    for (const double at : {-1.0, -0.46875, 0.0, 0.03125, 0.53125, 1.0}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const double start : {-3.0, 0.03125, 0.0}) {
                Ray ray{Vec3d(at), {}};
                ray.origin[axis] = start;
                ray.direction = {};
                ray.direction[axis] = 1;
                const MarchedRay r = marcher(ray, {});
                EXPECT_TRUE(std::isfinite(length(r.radiance)));
                EXPECT_GE(min_component(r.radiance), 0);
                EXPECT_LE(max_component(r.transmittance), 1);
            }
        }
    }
}

TEST(March, ObeysItsJobAndRefusesWhatItCannot) {
    View view = view_of({cloud(coefficients(Vec3d(1), Vec3d(5)))});
    Job job;
    job.cancel();
    EXPECT_THROW(make_march_method({})->render(view, {}, job), Error);
    Job other;
    RenderSettings settings;
    settings.depth = 0;
    EXPECT_THROW(make_march_method({})->render(view, settings, other), Error);
}

TEST(SkyDirections, CoverTheSphereAndHoldAllTheLight) {
    const EnvironmentMap::Ptr map =
        std::make_shared<const EnvironmentMap>(64, 32, [](const Vec3d& d) {
            const double hot = std::exp(200 * (dot(d, normalize(Vec3d(1, 2, 1))) - 1));
            return Vec3f(Vec3d(0.2 + 50 * hot, 0.3, 0.4 + 0.2 * d.z));
        });
    const EnvironmentLight light(map, {}, Vec3f(1));
    const std::vector<const Light*> lights{&light};
    const Vec3d forward(0, 1, 0);
    for (const int count : {24, 100, 500}) {
        const auto sky = sky_directions(lights, HenyeyGreensteinPhase{0.5f}, {&forward, 1}, count);
        EXPECT_LE(static_cast<int>(sky.size()), count);
        EXPECT_GE(static_cast<int>(sky.size()), count - 3);
        double area = 0, red = 0, largest = 0;
        for (const SkyDirection& d : sky) {
            EXPECT_NEAR(length(d.direction), 1, 1e-9);
            area += static_cast<double>(d.solid_angle);
            red += static_cast<double>(d.solid_angle * d.radiance.x);
            largest = std::max(largest, static_cast<double>(d.solid_angle * d.radiance.x));
        }
        EXPECT_NEAR(area, 4 * pi, 1e-4);
        EXPECT_NEAR(red / (4 * pi), light.mean_radiance({}).x, 0.01 * light.mean_radiance({}).x);
        EXPECT_LT(largest / red, count == 500 ? 0.03 : 0.6);
    }
}

// What one march cannot do is refused by name, with the method that can.
TEST(March, RefusesSurfacesThatItCannotShade) {
    const auto refusal = [](const MaterialKind kind, bool is_holdout) -> std::string {
        SphereSurface ball;
        ball.name = "lens";
        ball.material.kind = kind;
        ball.material.holdout = is_holdout;
        View view;
        view.surfaces = SurfaceSet({ball}, 0);
        Job job;
        try {
            make_march_method({})->render(view, {}, job);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    for (const MaterialKind kind : {MaterialKind::Conductor, MaterialKind::Dielectric,
                                    MaterialKind::Plastic, MaterialKind::None}) {
        const std::string text = refusal(kind, false);
        EXPECT_NE(text.find("'lens'"), text.npos);
        EXPECT_NE(text.find("take method 'path'"), text.npos) << text;
    }
    EXPECT_EQ(refusal(MaterialKind::Lambert, false), "");
    EXPECT_NE(refusal(MaterialKind::Lambert, true), "");
}

}  // namespace
}  // namespace gischt
