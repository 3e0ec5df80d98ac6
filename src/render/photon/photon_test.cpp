// SPDX-License-Identifier: Apache-2.0
// Photon mapping against the path tracer, and what a method has to keep to.
#include "render/photon/photon.h"

#include <gtest/gtest.h>

#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/params.h"
#include "render/photon/photon_views.h"

namespace gischt {
namespace {

using namespace photon_test;

View lit(std::vector<LightPtr> lights) {
    View view;
    view.camera = ortho({2, -3, 1}, 2.6);
    view.lights = std::move(lights);
    view.background = Vec3f{};
    return view;
}

MediumPtr ball_of_fog(const Vec3d& extinction, const Vec3d& albedo, double g) {
    return solid(Region::sphere({0, 0, 0}, 0.8), coefficients(extinction, albedo, g));
}

struct Scene {
    std::string name;
    View view;
};

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    const LightPtr sun = delta_sun({-1, 1, 1}, {3, 2, 1});
    const LightPtr point = std::make_shared<PointLight>(Vec3d(1.3, 0.2, 0.9), Vec3f(1, 2, 3));
    View even = lit({sun});
    even.media = {ball_of_fog(Vec3d(4), {0.95, 0.9, 0.8}, 0.5)};
    all.push_back({"even ball, sun", even});
    View colored = lit({point, sky(Vec3f(0.1f))});
    colored.media = {ball_of_fog({1, 4, 12}, Vec3d(0.9), -0.3)};
    all.push_back({"colored ball, point and sky", colored});
    View lumpy = lit({sun, sky({0.2f, 0.3f, 0.4f})});
    lumpy.media = {voxels(
        16, [](const Vec3d& p) { return lumps(p); },
        coefficients(Vec3d(8), {0.95, 0.9, 0.8}, 0.6))};
    all.push_back({"voxels", lumpy});
    // A box of fog on a table under a lamp.
    View table = lit({});
    table.media = {
        solid(Region::box({Vec3d(-0.5), Vec3d(0.5)}), coefficients(Vec3d(3), Vec3d(0.9)))};
    BoxSurface board;
    board.center = Keyed<Vec3d>(Vec3d(0, 0, -0.65));
    board.size = {1.4, 1.4, 0.2};
    board.material.albedo = Vec3d(0.8, 0.6, 0.4);
    RectSurface lamp;
    lamp.center = Keyed<Vec3d>(Vec3d(0.3, 0, 1.5));
    lamp.normal = {0, 0, -1};
    lamp.size = {0.6, 0.6};
    lamp.material.emission = Keyed<Vec3d>(Vec3d(6, 5, 4));
    table.surfaces = SurfaceSet({board, lamp}, 0);
    all.push_back({"table and lamp", table});
    return all;
}

PhotonParams fine() {
    PhotonParams params;
    params.photons = 20'000;
    params.nearest = 12;
    return params;
}

// The ball of a photon, or of a gathering, blurs; `bias` relative to the mean is allowed for that.
void expect_agreement(const Scene& scene, const PhotonParams& params, int depth,
                      const Effort& effort, double bias, double most_error) {
    PathParams plain;
    Effort reference = effort;
    reference.samples *= 4;
    reference.depth = depth;
    const Estimate truth = mean_radiance(scene.view, plain, reference);
    Effort mapped = effort;
    mapped.depth = depth;
    const Estimate got = mapped_radiance(scene.view, params, mapped);
    for (int c = 0; c < 3; ++c) {
        const double off = std::abs(got.mean[c] - truth.mean[c]);
        const double error = std::hypot(got.error[c], truth.error[c]);
        EXPECT_LE(off, critical_z(100, effort.batches) * error + bias * truth.mean[c])
            << scene.name << " depth " << depth << " channel " << c << ": " << got.mean[c] << " +- "
            << got.error[c] << " and " << truth.mean[c] << " +- " << truth.error[c];
        EXPECT_LT(error, most_error * truth.mean[c]) << scene.name << " depth " << depth;
    }
}

constexpr Effort brief{.batches = 16, .samples = 64, .seed = 1};

TEST(PhotonAgreement, WithThePathTracerByBeams) {
    for (const Scene& scene : scenes()) expect_agreement(scene, fine(), 32, brief, 0.006, 0.06);
}
TEST(PhotonAgreement, WithThePathTracerByPoints) {
    PhotonParams params = fine();
    params.gather = PhotonGather::Points;
    for (const Scene& scene : scenes()) expect_agreement(scene, params, 32, brief, 0.05, 0.06);
}

// Fog around a glass ball under a lamp, seen through the ball as well: light that comes through the
// glass, which the path tracer finds by chance.
Scene volume_caustic() {
    View view = lit({});
    view.media = {
        solid(Region::box({Vec3d(-1), Vec3d(1)}), coefficients(Vec3d(0.5), Vec3d(0.8), 0.2))};
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(0, 0, 0.3));
    ball.radius = Keyed<double>(0.4);
    ball.material.kind = MaterialKind::Dielectric;
    ball.material.medium = coefficients({0.3, 0.6, 0.9}, Vec3d(0.4));
    RectSurface lamp;
    lamp.center = Keyed<Vec3d>(Vec3d(0.4, 0, 1.6));
    lamp.target = Keyed<Vec3d>(Vec3d(0, 0, 0.3));
    lamp.size = {1, 1};
    lamp.material.emission = Keyed<Vec3d>(Vec3d(6, 5, 4));
    RectSurface floor;
    floor.center = Keyed<Vec3d>(Vec3d(0, 0, -0.9));
    floor.size = {1.6, 1.6};
    floor.material.albedo = Vec3d(0.7);
    view.surfaces = SurfaceSet({ball, lamp, floor}, 0);
    return {"volume caustic", view};
}

TEST(PhotonAgreement, OfCausticsInFogAndInGlass) {
    for (const int depth : {1, 32}) {
        expect_agreement(volume_caustic(), fine(), depth,
                         {.batches = 16, .samples = 256, .seed = 4}, 0.006, 0.04);
    }
}

TEST(PhotonAgreementLong, WithThePathTracer) {
    PhotonParams params = fine();
    params.photons = 200'000;
    std::vector<Scene> all = scenes();
    all.push_back(volume_caustic());
    for (const Scene& scene : all) {
        for (const int depth : {1, 2, 8, 64}) {
            expect_agreement(scene, params, depth, {.batches = 16, .samples = 1024, .seed = 5},
                             0.003, 0.02);
        }
    }
}

// A sun through glass in fog, which `path` refuses: what the fog scatters towards the eye is known
// from the flux. A slab of glass above a thin fog takes from a sun at normal incidence the share
// that Fresnel's formulae let through both faces: 2n/(n^2 + 1) with all reflections inside.
TEST(Photon, SunShinesThroughGlassIntoFog) {
    constexpr double n = 1.5, thin = 0.05;
    BoxSurface pane;
    pane.center = Keyed<Vec3d>(Vec3d(0, 0, 0.9));
    pane.size = {4, 4, 0.1};
    pane.material.kind = MaterialKind::Dielectric;
    pane.material.ior = n;
    View view;
    view.camera = ortho({0, -5, 0}, 1);
    view.media = {
        solid(Region::box({Vec3d(-0.8), Vec3d(0.8)}), coefficients(Vec3d(thin), Vec3d(1)))};
    view.surfaces = SurfaceSet({pane}, 0);
    view.lights = {delta_sun({0, 0, 1}, Vec3f(2))};
    PhotonParams params = fine();
    params.photons = 4000;
    const Estimate got = mapped_radiance(view, params, {.depth = 1, .batches = 32, .samples = 64});
    // Along the ray of 1.6 m, and from above to the ray, on average over the picture of 1 m.
    const auto mean_exp = [](double a, double b) {
        return (std::exp(-a) - std::exp(-b)) / (b - a);
    };
    const double truth = 2 * 2 * n / (n * n + 1) * (1 - std::exp(-1.6 * thin)) / (4 * pi) *
                         mean_exp(0.3 * thin, 1.3 * thin);
    expect_mean(got, 0, truth, 1, "pane", 1e-3);
    EXPECT_LT(got.error.x, 0.015 * truth);
}

// The mean over maps converges: with a reduction of 2/3 bias and noise fall alike, and the error
// with the cube root of their number.
TEST(PhotonLong, ErrorFallsWithTheCubeRootOfThePasses) {
    View view = lit({delta_sun({-1, 1, 1}, Vec3f(3))});
    view.media = {voxels(
        16, [](const Vec3d& p) { return lumps(p); }, coefficients(Vec3d(8), Vec3d(0.95), 0.6))};
    constexpr int edge = 4;
    const int most = 128, runs = 8;
    PhotonParams params = fine();
    params.photons = 3000;
    params.reduction = 2.0 / 3;
    params.nearest = 30;
    Traced traced(view, PathParams{}, 32);
    std::vector<double> truth;
    const auto ray_of = [&](int p, const PixelSampler&) {
        return view.camera.ray((p % edge + 0.5) / edge, (p / edge + 0.5) / edge);
    };
    for (int p = 0; p < edge * edge; ++p) {
        double sum = 0;
        const int n = 20'000;
        for (int i = 0; i < n; ++i) {
            const PixelSampler numbers(7, 1, p % edge, p / edge, static_cast<std::uint32_t>(i));
            sum += double(traced.tracer(ray_of(p, numbers), 0.5f, numbers).radiance.x);
        }
        truth.push_back(sum / n);
    }
    Mapped mapped(view, params, 32);
    std::map<int, double> square;
    for (int run = 0; run < runs; ++run) {
        std::vector<double> sum(truth.size());
        for (int pass = 0; pass < most; ++pass) {
            mapped.make(random_key(11, static_cast<std::uint64_t>(run)), pass);
            for (std::size_t p = 0; p < truth.size(); ++p) {
                // Direct light without noise to speak of.
                for (int i = 0; i < 4; ++i) {
                    const PixelSampler numbers(static_cast<std::uint64_t>(run), 2,
                                               static_cast<int>(p), 0,
                                               static_cast<std::uint32_t>(4 * pass + i));
                    sum[p] += 0.25 * mapped(ray_of(static_cast<int>(p), numbers), numbers).x;
                }
            }
            const int passes = pass + 1;
            if (passes != 2 && passes != 16 && passes != most) continue;
            for (std::size_t p = 0; p < truth.size(); ++p) {
                square[passes] += std::pow(sum[p] / passes - truth[p], 2);
            }
        }
    }
    const double first = 0.5 * std::log(square[16] / square[2]) / std::log(8.0),
                 second = 0.5 * std::log(square[most] / square[16]) / std::log(8.0);
    RecordProperty("slope_2_16", std::to_string(first));
    RecordProperty("slope_16_128", std::to_string(second));
    EXPECT_LT(first, -0.26);
    EXPECT_GT(first, -0.48);
    EXPECT_LT(second, -0.26);
    EXPECT_GT(second, -0.48);
}

// With more photons in one map and a radius that shrinks as their number to the power -1/6, the
// error falls as its cube root too: noise of 1 / (n r^2) and bias of r^2.
TEST(PhotonLong, ErrorFallsWithTheNumberOfPhotons) {
    View view = lit({delta_sun({-1, 1, 1}, Vec3f(3))});
    view.media = {ball_of_fog(Vec3d(4), Vec3d(0.95), 0.3)};
    Traced traced(view, PathParams{}, 32);
    const Ray ray = view.camera.ray(0.6, 0.45);
    double truth = 0;
    for (int i = 0; i < 200'000; ++i) {
        const PixelSampler numbers(3, 1, 0, 0, static_cast<std::uint32_t>(i));
        truth += double(traced.tracer(ray, 0.5f, numbers).radiance.x) / 200'000;
    }
    const auto error = [&](std::int64_t photons, double radius) {
        PhotonParams params = fine();
        params.photons = photons;
        params.radius = radius;
        Mapped mapped(view, params, 32);
        double square = 0;
        constexpr int maps = 48;
        for (int m = 0; m < maps; ++m) {
            mapped.make(static_cast<std::uint64_t>(m));
            double sum = 0;
            for (int i = 0; i < 64; ++i) {
                const PixelSampler numbers(random_key(4, static_cast<std::uint64_t>(m)), 1, 0, 0,
                                           static_cast<std::uint32_t>(i));
                sum += mapped(ray, numbers).x / 64;
            }
            square += std::pow(sum - truth, 2) / maps;
        }
        return std::sqrt(square);
    };
    const double few = error(2000, 0.2), many = error(2000 * 64, 0.1);
    EXPECT_LT(std::log(many / few) / std::log(64.0), -0.24);
}

Image render_with(const View& view, const PhotonParams& photon, const RenderSettings& settings) {
    RenderParams params;
    params.photon = photon;
    Job job;
    return make_method("photon", params)->render(view, settings, job).image;
}

View small_picture() {
    View view = volume_caustic().view;
    view.camera = ortho({2, -3, 1}, 2.6, 12);
    return view;
}

TEST(Photon, IsTheSameOnAnyNumberOfThreads) {
    const View view = small_picture();
    PhotonParams params = fine();
    params.photons = 6000;
    RenderSettings settings;
    settings.samples_per_pixel = 6;
    settings.depth = 8;
    const auto on = [&](int threads) {
        const ThreadLimit limit(threads);
        return render_with(view, params, settings);
    };
    const Image one = on(1), two = on(2);
    for (const Channel& c : one.planes) EXPECT_EQ(c.values, two.find(c.name)->values) << c.name;
}

TEST(Photon, GoesOnWithAFilm) {
    const View view = small_picture();
    PhotonParams params = fine();
    params.photons = 6000;
    RenderSettings settings;
    settings.depth = 8;
    settings.samples_per_pixel = 11;
    const Image whole = render_with(view, params, settings);
    FilmState film;
    settings.film = &film;
    for (const int samples : {3, 6, 11}) {
        settings.samples_per_pixel = samples;
        const Image part = render_with(view, params, settings);
        if (samples < 11) continue;
        for (const Channel& c : whole.planes) {
            EXPECT_EQ(c.values, part.find(c.name)->values) << c.name;
        }
    }
}

TEST(Photon, RefusesWhatItCannotDo) {
    const auto refuses = [](const View& view, const std::string& what) {
        try {
            RenderSettings settings;
            settings.depth = 4;
            render_with(view, fine(), settings);
            ADD_FAILURE() << what;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Usage);
            EXPECT_NE(e.fact().find(what), std::string::npos) << e.fact();
            EXPECT_FALSE(e.hint().empty());
        }
    };
    View endless = lit({delta_sun({0, 0, 1}, Vec3f(1))});
    endless.media = {solid(Region::everywhere(), coefficients(Vec3d(1), Vec3d(0.5)))};
    refuses(endless, "no end");
    View ground = lit({});
    GroundSurface lava;
    lava.name = "lava";
    lava.material.emission = Keyed<Vec3d>(Vec3d(1));
    ground.surfaces = SurfaceSet({lava}, 0);
    refuses(ground, "'lava' glows without end");
    View moving = lit({});
    SphereSurface ball;
    ball.name = "ball";
    ball.center = Keyed<Vec3d>({0, 1}, {Vec3d(), Vec3d(1, 0, 0)});
    moving.surfaces = SurfaceSet({ball}, 0.5, {0, 0, 1}, 0.5);
    refuses(moving, "'ball' moves");
}

// Light that comes straight from its source is that of the path tracer, to the bit.
TEST(Photon, DirectLightIsThatOfThePathTracer) {
    View view = lit({delta_sun({-1, 1, 1}, {3, 2, 1})});
    view.camera = ortho({2, -3, 1}, 2.6, 8);
    view.media = {ball_of_fog(Vec3d(4), Vec3d(0.9), 0.5)};
    RenderSettings settings;
    settings.samples_per_pixel = 2;
    settings.depth = 1;
    RenderParams params;
    params.path.splits = params.path.points;
    params.path.bridge = false;
    Job job;
    const Image path = make_method("path", params)->render(view, settings, job).image;
    const Image photon = render_with(view, fine(), settings);
    for (const Channel& c : path.planes) EXPECT_EQ(c.values, photon.find(c.name)->values);
}

// Maps of several sources differ no more than their photons do by chance.
TEST(Photon, SourcesTogetherBringTheSumOfTheirLight) {
    View view;
    view.camera = ortho({0, -4, 0}, 2);
    view.media = {voxels(
        16, [](const Vec3d& p) { return lumps(p); }, coefficients(Vec3d(20), Vec3d(0.97)))};
    view.lights = {delta_sun({-1, -1, 1}, Vec3f(3)), sky({0.1f, 0.15f, 0.25f})};
    PhotonParams params;
    params.photons = 60'000;
    const Estimate got =
        mapped_radiance(view, params, {.depth = 24, .batches = 12, .samples = 256, .seed = 3});
    const Estimate expected =
        mean_radiance(view, {}, {.depth = 24, .batches = 32, .samples = 256, .seed = 4});
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(got.error[c], 0.012 * got.mean[c]);
        // The blur of the photons' balls beside the edges of a thick cloud.
        const double error = std::hypot(got.error[c], expected.error[c]);
        EXPECT_NEAR(got.mean[c], expected.mean[c],
                    critical_z(3, 12) * error + 0.02 * expected.mean[c]);
    }
}

}  // namespace
}  // namespace gischt
