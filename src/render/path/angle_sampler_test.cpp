// SPDX-License-Identifier: Apache-2.0
// Equi-angular distances, and the airlight of lights at finite places against its closed form.
#include "render/path/angle_sampler.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>

#include "base/units.h"
#include "math/quadrature.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

constexpr double never = std::numeric_limits<double>::infinity();

const Ray ray{{0, 0, 0}, {1, 0, 0}};

struct Lights {
    std::vector<LightPtr> owned;
    std::vector<const Light*> all;

    explicit Lights(std::vector<LightPtr> lights) : owned(std::move(lights)) {
        for (const LightPtr& l : owned) all.push_back(l.get());
    }
};

LightPtr point(const Vec3d& at, float intensity) {
    return std::make_shared<PointLight>(at, Vec3f(intensity));
}

// Chi-squared in bins of equal probability under the density, and the density integrates to 1.
TEST(AngleSampler, DrawsFromItsDensity) {
    const Lights sets[] = {Lights({point({5, 1, 0}, 1)}),
                           Lights({point({-2, 0.1, 0}, 1), point({8, 3, 1}, 20)}),
                           Lights({point({3, 0, 0}, 1)}),
                           Lights({std::make_shared<SpotLight>(
                               Vec3d(4, 2, 0), normalize(Vec3d(1, -1, 0)), Vec3f(3), 0.1, 0.2)})};
    for (const Lights& lights : sets) {
        for (const double t1 : {10.0, never}) {
            AngleSampler sampler;
            sampler.aim(lights.all, ray, 0.5, t1);
            ASSERT_FALSE(sampler.is_empty());
            // By x = 1 / (1 + t), as the end may be far away; fine near t = 3.
            constexpr int steps = 400'000, bins = 32;
            const double last = t1 < never ? 1 / (1 + t1) : 0, first = 1 / 1.5;
            std::vector<double> cumulative{0};
            for (int i = 0; i < steps; ++i) {
                const double x = last + (first - last) * (i + 0.5) / steps, t = 1 / x - 1;
                cumulative.push_back(cumulative.back() +
                                     double(sampler.density(t)) / (x * x) * (first - last) / steps);
            }
            // A light on the ray has a peak that is too narrow for this sum.
            if (lights.all.size() == 1 && lights.owned[0]->place()->center.y == 0) continue;
            EXPECT_NEAR(cumulative.back(), 1, 1e-4);
            std::array<int, bins> seen{};
            constexpr int draws = 64'000;
            for (int i = 0; i < draws; ++i) {
                const double t = sampler.sample(random_uniform(7, static_cast<std::uint32_t>(i)));
                ASSERT_GE(t, 0.5);
                ASSERT_LE(t, t1);
                const double x = (1 / (1 + t) - last) / (first - last);
                const auto at = static_cast<std::size_t>(std::clamp(x, 0.0, 1.0) * steps);
                const double share = cumulative[std::min(at, cumulative.size() - 1)];
                ++seen[static_cast<std::size_t>(std::clamp(share * bins, 0.0, bins - 0.5))];
            }
            double chi2 = 0;
            for (const int n : seen) chi2 += std::pow(n - draws / bins, 2) / (draws / bins);
            EXPECT_LT(chi2, 73) << "the 1e-4 quantile of 31 degrees of freedom is 70.0";
        }
    }
}

TEST(AngleSampler, LeavesOutWhatDoesNotShineThere) {
    const Lights away(
        {std::make_shared<SpotLight>(Vec3d(4, 2, 0), Vec3d(0, 1, 0), Vec3f(3), 0.1, 0.2),
         sky(Vec3f(1))});
    AngleSampler sampler;
    sampler.aim(away.all, ray, 0, 10);
    EXPECT_TRUE(sampler.is_empty());
    sampler.aim(Lights({point({5, 1, 0}, 1)}).all, ray, 3, 3);
    EXPECT_TRUE(sampler.is_empty());
}

// A point light in fog: sigma_s I p times the integral from 0 to 10 of exp(-sigma (t + r)) / r^2,
// r^2 = 1 + (t - 5)^2; isotropic.
View foggy(double extinction, const Vec3d& light = {0, 1, 0}) {
    View view;
    view.media = {solid(Region::box({{-5, -50, -50}, {5, 50, 50}}),
                        coefficients(Vec3d(extinction), Vec3d(0.8)))};
    view.lights = {point(light, 4)};
    view.camera = ortho({-5, 0, 0}, 1e-6);
    return view;
}

double airlight(double extinction, const Vec3d& light) {
    static const GaussLegendre rule(64);
    double sum = 0;
    const double h2 = light.y * light.y + light.z * light.z;
    // By the angle, in which the square law is gone.
    const double h = std::sqrt(h2), a = std::atan((-5 - light.x) / h),
                 b = std::atan((5 - light.x) / h);
    for (int i = 0; i < 8; ++i) {
        sum += rule.integrate(a + (b - a) * i / 8, a + (b - a) * (i + 1) / 8, [&](double angle) {
            const double s = h * std::tan(angle), r = std::sqrt(h2 + s * s);
            return std::exp(-extinction * (light.x + s + 5 + r)) / h;
        });
    }
    return 0.8 * extinction * 4 / (4 * pi) * sum;
}

TEST(AngleSampler, AirlightIsThatOfTheClosedForm) {
    // The published figures (reference: D = 5, h = 1) per sigma_s I p.
    EXPECT_NEAR(airlight(0.1, {0, 1, 0}) / (0.8 * 0.1 * 4 / (4 * pi)), 1.42945269, 1e-7);
    EXPECT_NEAR(airlight(1, {0, 1, 0}) / (0.8 * 4 / (4 * pi)), 0.00710817, 1e-7);
    for (const double extinction : {0.01, 0.1, 1.0}) {
        for (const Vec3d& light : {Vec3d(0, 1, 0), Vec3d(2, 0.05, 0), Vec3d(-4, 0, 8)}) {
            for (const int points : {0, 1, 4}) {
                PathParams params;
                params.equiangular = points;
                const Estimate got = mean_radiance(foggy(extinction, light), params,
                                                   {.depth = 1, .batches = 64, .samples = 64});
                expect_mean(got, 0, airlight(extinction, light), 27,
                            fmt::format("extinction {} at {} {} {}, {} points", extinction, light.x,
                                        light.y, light.z, points),
                            1e-5);
            }
        }
    }
}

// Next to a light the square law is what makes the noise.
TEST(AngleSampler, TakesTheNoiseOfTheSquareLaw) {
    const View view = foggy(0.05, {2, 0.05, 0});
    const auto variance = [&](int points) {
        PathParams params;
        params.points = 8;
        params.equiangular = points;
        const Estimate e = mean_radiance(view, params, {.depth = 1, .batches = 256, .samples = 8});
        return e.error.x * e.error.x;
    };
    EXPECT_LT(variance(4), 0.02 * variance(0));
}

// Media of several colours that overlap, spots and lamps with a size: the same mean with and
// without.
TEST(AngleSampler, ChangesNoMean) {
    View view;
    view.media = {
        solid(Region::box({Vec3d(-1), Vec3d(1)}), coefficients({1, 2, 0}, Vec3d(0.7), 0.5)),
        voxels(
            16, [](const Vec3d& p) { return p.x > 0 ? lumps(p) : 0.0; },
            coefficients({2, 1, 3}, Vec3d(0.9)))};
    view.lights = {
        point({0.2, 0.3, 1.2}, 2),
        std::make_shared<SpotLight>(Vec3d(-0.4, -2, 0), Vec3d(0, 1, 0), Vec3f(9), 0.2, 0.4)};
    SphereSurface ball;
    ball.center = Vec3d(0.2, 0.5, -0.4);
    ball.radius = 0.2;
    ball.material.emission = Keyed<Vec3d>(Vec3d(3));
    view.surfaces = SurfaceSet({ball}, 0);
    view.camera = ortho({-5, 0.4, 0.3}, 1.5);
    std::vector<Estimate> got;
    for (const int points : {0, 3}) {
        PathParams params;
        params.equiangular = points;
        got.push_back(mean_radiance(
            view, params,
            {.depth = 3, .batches = 200, .samples = 64, .seed = 5 + std::uint64_t(points)}));
    }
    expect_same_mean(got[0], got[1], 3, "equiangular");
}

}  // namespace
}  // namespace gischt
