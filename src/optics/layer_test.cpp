// SPDX-License-Identifier: Apache-2.0
#include "optics/layer.h"

#include <gtest/gtest.h>

#include <tuple>

#include "base/error.h"
#include "base/random.h"
#include "math/quadrature.h"
#include "optics/medium.h"

namespace gischt {
namespace {

constexpr double earth = 6.36e6;  // m
const HeightProfile air{HeightProfile::Kind::Exponential, 8000, 0};
const HeightProfile haze{HeightProfile::Kind::Exponential, 1200, 0};
const HeightProfile ozone{HeightProfile::Kind::Tent, 15e3, 25e3};
constexpr double never = std::numeric_limits<double>::infinity();

Layer fog(double scale_height, double top = never) {
    return Layer::flat({0, 0, 1}, 2, {HeightProfile::Kind::Exponential, scale_height, 0}, top);
}
Layer planet(const HeightProfile& profile) {
    return Layer::round({0, 0, -earth}, earth, profile, 100e3);
}

// The integral by brute force: 400 panels of a rule of 8.
double by_quadrature(const Layer& layer, const Ray& ray) {
    static const GaussLegendre rule(8);
    double sum = 0;
    for (int i = 0; i < 400; ++i) {
        const double h = (ray.t_max - ray.t_min) / 400, t = ray.t_min + i * h;
        sum += rule.integrate(t, t + h, [&](double x) { return layer.density(ray.at(x)); });
    }
    return sum * length(ray.direction);
}

// Random rays around a layer, from near and far, with directions of any length.
Ray random_ray(std::uint64_t i, double spread, double reach) {
    const auto u = [i](std::uint32_t d) {
        return 2 * static_cast<double>(random_uniform(random_key(3, i), d)) - 1;
    };
    Ray ray;
    ray.origin = spread * Vec3d(u(0), u(1), std::abs(u(2)));
    ray.direction = (0.5 + std::abs(u(6))) * normalize(Vec3d(u(3), u(4), u(5)));
    ray.t_max = reach;
    return ray;
}

TEST(Layer, FogHasItsClosedForm) {
    // Upwards from the ground: scale height times density; at an angle over the cosine.
    const Layer layer = fog(30);
    EXPECT_NEAR(layer.column({{0, 0, 2}, {0, 0, 1}}), 30, 1e-7);
    EXPECT_NEAR(layer.column({{5, 5, 32}, {0.6, 0, 0.8}}), 30 * std::exp(-1) / 0.8, 1e-7);
    // Down from far above into the layer of constant density below the base, to 10 m deep.
    EXPECT_NEAR(layer.column({{0, 0, 1e5}, {0, 0, -2}, 0, 0.5e5 + 4}), 30 + 10, 1e-5);
    EXPECT_TRUE(std::isinf(layer.column({{0, 0, 50}, {1, 0, 0}})));
    EXPECT_TRUE(std::isinf(layer.column({{0, 0, 50}, {1, 0, -1e-3}})));
    EXPECT_EQ(layer.column({{0, 0, 1e5}, {1, 0, 0}}), 0);
    EXPECT_NEAR(layer.column({{0, 0, 32}, {3, 0, 0}, 1, 2}), 3 * std::exp(-1), 1e-12);
    // A ray that is almost level has the column of the level one.
    EXPECT_NEAR(layer.column({{0, 0, 32}, {1, 0, 1e-12}, 0, 100}), 100 * std::exp(-1), 1e-8);
    EXPECT_NEAR(fog(30, 15).column({{0, 0, -3}, {0, 0, 1}}), 5 + 30 * (1 - std::exp(-0.5)), 1e-9);
}

TEST(Layer, ZenithColumnOfAPlanetIsItsScaleHeight) {
    // The sphere does not matter straight up; the top at 100 km cuts exp(-12.5) off.
    EXPECT_NEAR(planet(air).column({{0, 0, 0}, {0, 0, 1}}) / (8000 * (1 - std::exp(-12.5))), 1,
                1e-6);
    EXPECT_NEAR(planet(haze).column({{0, 0, 0}, {0, 0, 1}}) / 1200, 1, 1e-6);
    EXPECT_NEAR(planet(ozone).column({{0, 0, 0}, {0, 0, 1}}) / 15e3, 1, 1e-6);
    EXPECT_NEAR(planet(air).column({{0, 0, 16e3}, {0, 0, 1}}) / 8000,
                std::exp(-2) - std::exp(-12.5), 1e-6);
    // The chord through everything from space, twice; the planet itself is empty.
    EXPECT_NEAR(planet(haze).column({{0, 0, 1e9}, {0, 0, -1}}) / 2400, 1, 1e-6);
}

// Towards the horizon the column is the Chapman function, about sqrt(pi R / 2 H) scale heights
// (with its next term, 1 + 3 H / 8 R).
TEST(Layer, HorizonColumnIsChapmans) {
    const double chapman = std::sqrt(pi * earth * 1200 / 2) * (1 + 3.0 / 8 * 1200 / earth);
    EXPECT_NEAR(planet(haze).column({{0, 0, 0}, {0, 1, 0}}) / chapman, 1, 1e-6);
}

TEST(Layer, ColumnsGrowMonotonouslyToTheHorizon) {
    for (const HeightProfile& profile : {air, haze, ozone}) {
        double before = 0;
        for (int i = 0; i <= 900; ++i) {
            const double angle = 0.1 * i * pi / 180;
            const double column =
                planet(profile).column({{0, 0, 1}, {std::sin(angle), 0, std::cos(angle)}});
            EXPECT_TRUE(std::isfinite(column));
            EXPECT_GT(column, before);
            before = column;
        }
    }
}

TEST(Layer, ColumnsAgreeWithBruteForce) {
    for (std::uint64_t i = 0; i < 300; ++i) {
        const Ray low = random_ray(i, 60, 40);
        EXPECT_NEAR(fog(7).column(low), by_quadrature(fog(7), low), 2e-4) << i;
        Ray far = random_ray(i, 60e3, 400e3);
        far.direction.z = std::abs(far.direction.z);  // not into the planet
        for (const HeightProfile& profile : {air, haze, ozone}) {
            // Brute force sees the corners of the tent only so well.
            const double brute = by_quadrature(planet(profile), far);
            EXPECT_NEAR(planet(profile).column(far), brute, 3e-4 * brute + 0.3) << i;
        }
    }
}

// Runs in order, without gaps where there is matter; bounds that hold and are tight; the mean
// exact; the look-up in float right.
TEST(Layer, RunsBoundTheDensity) {
    const auto check = [](const Layer& layer, const Ray& ray, std::uint64_t i) {
        LayerWalk walk(layer, ray);
        double column = 0, before = ray.t_min;
        for (LayerRun run; walk.next(run);) {
            ASSERT_LT(run.t0, run.t1);
            ASSERT_GE(run.t0, before);
            before = run.t1;
            const double span = run.t1 - run.t0, tail = 1.0 / 64;
            const bool is_tent = layer.profile().kind == HeightProfile::Kind::Tent;
            EXPECT_TRUE(run.max <= 2.001 * run.min || run.max <= 1.001 * tail) << i;
            EXPECT_LE(run.min, run.mean);
            EXPECT_LE(run.mean, run.max);
            for (const double w : {1e-4, 0.2, 0.5, 0.8, 0.9999}) {
                const double truth = layer.density(ray.at(run.t0 + w * span));
                const auto seen =
                    static_cast<double>(density_on_run(layer.profile(), layer.is_round(), run.entry,
                                                       run.step, static_cast<float>(w * span)));
                EXPECT_NEAR(seen, truth, 1e-5 * run.max + (is_tent ? 5e-7 : 0)) << i;
                EXPECT_GE(seen, run.min) << i;
                EXPECT_LE(seen, run.max) << i;
            }
            column += run.mean * span * length(ray.direction);
        }
        EXPECT_NEAR(column, layer.column(ray), 3e-6 * column + (layer.is_round() ? 1e-3 : 1e-9))
            << i;
    };
    for (std::uint64_t i = 0; i < 500; ++i) {
        check(fog(7), random_ray(i, 60, 40), i);
        check(fog(7, 20), random_ray(i, 60, 400), i);
        for (const HeightProfile& profile : {air, haze, ozone}) {
            check(planet(profile), random_ray(i, 60e3, 4e6), i);
            Ray space = random_ray(i, 6.5e6, 4e7);  // grazing and hitting from far away
            space.origin = space.origin + Vec3d(0, 0, -earth) - 1.5e7 * space.direction;
            check(planet(profile), space, i);
        }
    }
}

TEST(Layer, ALevelRayGoesOnForEver) {
    const Layer layer = fog(10);
    const Ray ray{{0, 0, 12}, {0, 2, 0}, 1};
    LayerWalk walk(layer, ray);
    LayerRun run;
    ASSERT_TRUE(walk.next(run));
    EXPECT_EQ(run.t0, 1);
    EXPECT_TRUE(std::isinf(run.t1));
    EXPECT_NEAR(run.mean, std::exp(-1), 1e-6);
    // A tracker must see that it is the same all along: it could not walk to the end.
    EXPECT_EQ(run.min, run.max);
    EXPECT_FALSE(walk.next(run));
    // Downwards: several runs, the last one below the base.
    LayerWalk down(layer, {{0, 0, 100}, {0, 0, -1}});
    int count = 0;
    while (down.next(run)) ++count;
    EXPECT_TRUE(std::isinf(run.t1));
    EXPECT_EQ(run.mean, 1);
    EXPECT_EQ(run.min, run.max);
    EXPECT_NEAR(run.t0, 98, 1e-9);
    EXPECT_EQ(count, 16);  // 98 m are 14.1 halvings
}

TEST(Layer, IsAMedium) {
    MediumParams params;
    params.absorption = Keyed<Vec3d>(Vec3d(0.01, 0.02, 0.04));
    params.scattering = Keyed<Vec3d>(Vec3d(0));
    params.density_scale = Keyed<double>(3.0);
    const Medium medium(fog(10), params, 0);
    EXPECT_FALSE(medium.is_bounded());
    EXPECT_FALSE(medium.has_lattice());
    EXPECT_NEAR(medium.majorant(), 0.12, 1e-6);
    const Ray ray{{0, 0, 7}, {0.6, 0, 0.8}};
    EXPECT_NEAR(*medium.optical_depth(ray, 0, never), 0.12 * 10 * std::exp(-0.5) / 0.8, 1e-6);
    SegmentWalk walk = medium.segments(ray);
    double depth = 0;
    for (MediumSegment s; walk.next(s);) {
        depth += static_cast<double>(s.mean) * (s.t1 - s.t0);
        const Vec3d middle = ray.at(0.5 * (s.t0 + s.t1));
        EXPECT_NEAR(medium.density_at(s, static_cast<float>(0.5 * (s.t1 - s.t0))),
                    medium.density(middle), 1e-5);
        EXPECT_GE(s.max, 0.04f * medium.density(middle));
    }
    EXPECT_NEAR(depth, *medium.optical_depth(ray, 0, never), 1e-6);
}

TEST(Layer, RefusesWhatHasNoThickness) {
    EXPECT_THROW(fog(0), Error);
    EXPECT_THROW(fog(-1), Error);
    EXPECT_THROW(fog(1, 0), Error);
    EXPECT_THROW(Layer::round({}, 0, air, 1), Error);
    EXPECT_THROW(Layer::round({}, 1, ozone, 5e3), Error);  // the tent begins above
    MediumParams params;
    params.emission = EmissionKind::Blackbody;
    EXPECT_THROW(Medium(fog(1), params, 0), Error);
}

}  // namespace
}  // namespace gischt
