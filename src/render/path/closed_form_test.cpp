// SPDX-License-Identifier: Apache-2.0
// Pictures that have a closed form, and single scattering by the march.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/units.h"
#include "optics/blackbody.h"
#include "render/march/ray_march.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

std::vector<PathParams> both_cameras() {
    std::vector<PathParams> both(2);
    both[1].camera = CameraSegment::Tracking;
    both[1].shadow = TransmittanceEstimator::Ratio;
    return both;
}

// The mean transmittance over the disc of an absorbing sphere is
// 2 / tau^2 (1 - (1 + tau) exp(-tau)), tau = 2 R sigma.
TEST(PathClosedForm, BeerAndLambert) {
    for (const auto& [tau, transmittance] : {std::pair{1.0, 0.528482}, std::pair{5.0, 0.076766}}) {
        View view;
        view.camera = ortho({0, -4, 0}, 2);
        view.lights = {sky({1, 1, 1})};
        view.media = {solid(Region::sphere({}, 1), coefficients(Vec3d(tau / 2), {}))};
        for (const PathParams& params : both_cameras()) {
            const Estimate got = mean_radiance(view, params, {.batches = 64, .samples = 4096});
            // The disc covers pi / 4 of the picture.
            const double expected = 1 - pi / 4 * (1 - transmittance);
            expect_mean(got, 0, expected, 4, fmt::format("tau {}", tau));
            EXPECT_LT(got.error.x, 0.002 * expected);
        }
    }
}

// L_e (1 - exp(-tau)).
TEST(PathClosedForm, EmittingAbsorber) {
    MediumParams params = coefficients({0.5, 1, 2}, {});
    params.emission = EmissionKind::Blackbody;
    View view;
    view.camera = ortho({0, -4, 0}, 1);
    view.media = {solid(Region::box({Vec3d(-1), Vec3d(1)}), params, 3000)};
    const Vec3f glow = blackbody_radiance(3000);
    for (const PathParams& p : both_cameras()) {
        for (const int depth : {0, 4}) {
            const Estimate got =
                mean_radiance(view, p, {.depth = depth, .batches = 64, .samples = 4096});
            for (int c = 0; c < 3; ++c) {
                const double tau = std::array{1.0, 2.0, 4.0}[static_cast<std::size_t>(c)];
                const double expected = double(glow[c]) * (1 - std::exp(-tau));
                // Black bodies come from a table.
                expect_mean(got, c, expected, 12, fmt::format("depth {}", depth), 2e-4);
                EXPECT_LT(got.error[c], 0.002 * expected);
            }
        }
    }
}

// The same holds for any density, with voxels in it beside which all others are next to nothing, so
// that flights go on cell by cell.
TEST(PathClosedForm, EmittingAbsorberOfAnyDensity) {
    const auto spikes = [](const Vec3d& p) {
        const auto voxel = [](double x) { return static_cast<int>((x + 1) * 8) % 8; };
        return voxel(p.x) == 2 && voxel(p.y) == 3 && voxel(p.z) == 4 ? 300 : lumps(p);
    };
    MediumParams params = coefficients({0.5, 1, 2}, {});
    params.emission = EmissionKind::Blackbody;
    Frame frame;
    add_field(frame, "density", 16, spikes);
    add_field(frame, "temperature", 16, [](const Vec3d&) { return 3000; });
    frame.fields["temperature"].background = {3000};
    Job job;
    View view;
    view.camera = ortho({-3, 2, 1}, 1.5);
    view.media = {std::make_shared<const Medium>(frame, params, 0, job)};
    const Vec3d glow(blackbody_radiance(3000));
    for (const PathParams& p : both_cameras()) {
        Traced traced(view, p, 1);
        Tracker exact;
        const Medium* media[] = {view.media[0].get()};
        exact.media = media;
        exact.is_grey = false;
        const Seen off = [&](const Ray& ray, const PixelSampler& numbers) {
            const Vec3d seen = traced.seen()(ray, numbers);
            const Vec3f depth = exact.exact_depth(ray);
            return seen / glow - (Vec3d(1) - Vec3d(exp(-depth)));
        };
        const Estimate got = mean_of_part(view, off, 0, 0, 1, {.batches = 64, .samples = 2048});
        for (int c = 0; c < 3; ++c) {
            // Black bodies come from a table.
            EXPECT_LE(std::abs(got.mean[c]), critical_z(6, 64) * got.error[c] + 2e-4) << c;
            EXPECT_LT(got.error[c], 0.005) << c;
        }
    }
}

// Integral from 0 to 10 of exp(-sigma (t + r)) / r^2 dt, r^2 = 1 + (t - 5)^2, times sigma I p.
TEST(PathClosedForm, AirlightOfAPointLight) {
    for (const auto& [sigma, integral] :
         {std::pair{1e-5, 2.74680153}, std::pair{0.1, 1.42945269}, std::pair{1.0, 0.00710817}}) {
        View view;
        view.camera = ortho({0, 0, -5}, 1e-9);
        view.media = {solid(Region::box({{-20, -20, 0}, {20, 20, 10}}),
                            coefficients(Vec3d(sigma), {1, 1, 1}))};
        view.lights = {std::make_shared<PointLight>(Vec3d(1, 0, 5), Vec3f(100))};
        const double expected = 100 * sigma * integral / (4 * pi);
        for (const PathParams& params : both_cameras()) {
            const bool tracks = params.camera == CameraSegment::Tracking;
            // Hardly a flight ends in what is next to nothing.
            if (tracks && sigma < 0.01) continue;
            const Estimate got = mean_radiance(
                view, params, {.depth = 1, .batches = 64, .samples = tracks ? 4096 : 2048});
            // The first one's closed form leaves out an extinction of up to 15 sigma.
            expect_mean(got, 0, expected, 5, fmt::format("sigma {}", sigma),
                        sigma < 0.01 ? 1.5e-4 : 1e-6);
            EXPECT_LT(got.error.x, (tracks ? 0.01 : 0.002) * expected) << sigma;
        }
    }
}

// One scattering in a cloud, by marching with steps that are halved until that changes nothing, and
// by tracing paths of depth 1.
TEST(PathClosedForm, OneScatteringIsThatOfTheMarch) {
    View view;
    view.camera = ortho({-2, -3, 1}, 2);
    view.background = Vec3f{};
    view.media = {voxels(
        32, [](const Vec3d& p) { return lumps(p); },
        coefficients({3, 6, 12}, {0.9, 0.95, 1}, 0.6))};
    const std::vector<std::vector<LightPtr>> lights{
        {delta_sun({1, -1, 1}, {3, 2, 1})},
        {std::make_shared<PointLight>(Vec3d(-1.2, -0.9, 1), Vec3f(2, 3, 4))}};
    constexpr int edge = 4;
    for (const auto& light : lights) {
        view.lights = light;
        Traced traced(view, {}, 1);
        for (int part = 0; part < edge * edge; ++part) {
            const int x = part % edge, y = part / edge;
            const Estimate path = mean_of_part(view, traced.seen(), x, y, edge,
                                               {.batches = 64, .samples = 64, .seed = 5});
            Estimate march;
            double change = 1;
            double step = 1;
            for (int i = 0; i < 6; ++i, step *= 0.5) {
                MarchParams params;
                params.light_cache = false;
                params.cutoff = 0;
                params.step = params.shadow_step = step;
                params.step_depth = 0.25 * step;
                Job job;
                const MarchScene scene(view, params, job);
                RayMarcher marcher(scene);
                const Vec3d before = march.mean;
                const Seen seen = [&](const Ray& ray, const PixelSampler& numbers) {
                    return Vec3d(marcher(ray, numbers).radiance);
                };
                march = mean_of_part(view, seen, x, y, edge, {.batches = 64, .samples = 16});
                change = max_component(abs(march.mean - before) / max(path.error, Vec3d(1e-30)));
                if (i > 0 && change < 1) break;
            }
            EXPECT_LT(change, 1) << x << " " << y;
            for (int c = 0; c < 3; ++c) {
                const double error = std::hypot(path.error[c], march.error[c]);
                EXPECT_NEAR(path.mean[c], march.mean[c],
                            (critical_z(6 * edge * edge, 64) + change) * error)
                    << x << " " << y << " channel " << c;
            }
        }
    }
}

}  // namespace
}  // namespace gischt
