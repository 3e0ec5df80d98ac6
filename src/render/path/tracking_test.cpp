// SPDX-License-Identifier: Apache-2.0
// Transmittance and free flights against quadrature.
#include "render/path/tracking.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "math/quadrature.h"
#include "render/path/test_views.h"

namespace gischt {
namespace {

using namespace path_test;

// A ray through [-1,1]^3 from outside.
Ray random_ray(std::uint64_t i) {
    const auto u = [i](std::uint32_t d) {
        return 2 * double(random_uniform(random_key(31, i), d)) - 1;
    };
    const Vec3d through(0.7 * u(0), 0.7 * u(1), 0.7 * u(2));
    const Vec3d direction = normalize(Vec3d(u(3), u(4), u(5)));
    return {through - 4 * direction, direction};
}

// Integral of the density along a ray by Medium::density, in double: two Gauss points between all
// the planes of the lattice of n voxels, where the trilinear interpolant is a cubic.
double by_quadrature(const Medium& medium, int n, const Ray& ray, double t1) {
    std::vector<double> cut{ray.t_min, std::min(t1, ray.t_max)};
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = -1; i <= n; ++i) {
            const double plane = -1 + (i + 0.5) * 2 / n;
            const double t = (plane - ray.origin[axis]) / ray.direction[axis];
            if (t > cut[0] && t < cut[1]) cut.push_back(t);
        }
    }
    std::sort(cut.begin(), cut.end());
    static const GaussLegendre rule(2);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
        sum += rule.integrate(cut[i], cut[i + 1],
                              [&](double t) { return double(medium.density(ray.at(t))); });
    }
    return sum;
}

// From next to nothing to very dense, with empty blocks.
double wild(const Vec3d& p) {
    const double lump = lumps(p, 3);
    return p.x * p.y > 0.2 ? 0 : lump * std::pow(10, 2 * p.z);
}

double soft(const Vec3d& p) {
    return lumps(p);
}

// In each block a voxel so dense that null collisions against its majorant would not end.
double spiky(const Vec3d& p) {
    const auto voxel = [](double x) { return static_cast<int>((x + 1) * 8) % 8; };
    return voxel(p.x) == 2 && voxel(p.y) == 3 && voxel(p.z) == 4 ? 1e12 : soft(p);
}

TEST(PathTracking, ExactDepthIsThatOfQuadrature) {
    const MediumPtr media[] = {voxels(24, wild, coefficients(Vec3d(1), Vec3d(1))),
                               voxels(20, soft, coefficients(Vec3d(1, 2, 3), Vec3d(1)))};
    for (std::uint64_t i = 0; i < 200; ++i) {
        const int which = static_cast<int>(i % 2);
        Ray ray = random_ray(i);
        if (i % 3 == 0) ray.t_max = 4.1;
        std::int64_t lookups = 0;
        const double expected = by_quadrature(*media[which], which == 0 ? 24 : 20, ray, 9);
        // Densities are kept in 16 bits.
        EXPECT_NEAR(exact_density_integral(*media[which], ray, lookups), expected,
                    1e-4 * expected + 1e-6);
    }
}

// No channel ends early because another one is thick.
TEST(PathTracking, ExactTransmittanceHoldsInEveryChannel) {
    const MediumPtr thick = voxels(
        16, [](const Vec3d& p) { return 1 + 0.5 * p.x; }, coefficients({0, 0.3, 60}, {}));
    const Medium* media[] = {thick.get()};
    Tracker tracker;
    tracker.media = media;
    tracker.is_grey = false;
    RandomStream random{1};
    const Ray ray{{-4, 0.1, 0.2}, {1, 0, 0}};
    const Vec3f got = tracker.transmittance(ray, TransmittanceEstimator::Exact, random);
    const double depth = by_quadrature(*thick, 16, ray, 9);
    EXPECT_EQ(got.x, 1);
    EXPECT_NEAR(double(got.y), std::exp(-0.3 * depth), 1e-5);
    EXPECT_NEAR(double(got.z), 0, 1e-5);
}

TEST(PathTracking, EstimatorsOfTransmittanceHaveTheRightMean) {
    const MediumPtr one = voxels(24, wild, coefficients({0.2, 1, 3}, Vec3d(0.5)));
    const MediumPtr two = voxels(16, soft, coefficients({2, 1, 0}, Vec3d(0.5)));
    const MediumPtr even = solid(Region::sphere({0.3, 0, 0}, 0.6), coefficients({1, 2, 3}, {}));
    const MediumPtr spikes = voxels(16, spiky, coefficients({2, 1, 0}, Vec3d(0.5)));
    const std::vector<std::vector<const Medium*>> sets{
        {one.get()},    {two.get()},
        {even.get()},   {one.get(), two.get(), even.get()},
        {spikes.get()}, {spikes.get(), one.get()}};
    constexpr int rays = 8;
    for (const auto& media : sets) {
        Tracker tracker;
        tracker.media = media;
        tracker.is_grey = false;
        for (std::uint64_t i = 0; i < rays; ++i) {
            const Ray ray = random_ray(100 + i);
            const Vec3f depth = tracker.exact_depth(ray);
            for (const auto kind :
                 {TransmittanceEstimator::Ratio, TransmittanceEstimator::ResidualRatio,
                  TransmittanceEstimator::March}) {
                // Even steps meet spikes so seldom that no sample of this size tells their mean.
                const bool has_spikes = media.front() == spikes.get();
                if (kind == TransmittanceEstimator::March && has_spikes) continue;
                float least = 1;
                const Estimate got = estimate(4000, [&](int n) {
                    RandomStream random{random_key(8, i, static_cast<std::uint64_t>(n))};
                    const Vec3f t = tracker.transmittance(ray, kind, random);
                    least = std::min(least, min_component(t));
                    return Vec3d(t);
                });
                // The march may go below, for the sake of the mean.
                EXPECT_TRUE(kind == TransmittanceEstimator::March || least >= 0);
                for (int c = 0; c < 3; ++c) {
                    expect_mean(got, c, std::exp(-std::min(double(depth[c]), 87.0)),
                                6 * rays * 3 * 3,
                                fmt::format("{} media, ray {}, estimator {}, channel {}",
                                            media.size(), i, static_cast<int>(kind), c));
                }
            }
        }
    }
}

// Where flights end: counts in bins of equal probability, a quarter of all beyond the last.
TEST(PathTracking, FlightsEndWhereTheDensityOfCollisionsIs) {
    const auto halves = [](const Vec3d& p) { return p.x < 0 ? 1.0 : 6.0; };
    const MediumPtr two_blocks = voxels(16, halves, coefficients(Vec3d(1), Vec3d(1)));
    const MediumPtr rough = voxels(24, wild, coefficients(Vec3d(3), Vec3d(1)));
    const MediumPtr even = solid(Region::box({Vec3d(-1), Vec3d(1)}), coefficients(Vec3d(1.5), {}));
    const Ray ray{{-4, 0.13, -0.21}, normalize(Vec3d(1, 0.02, 0.05))};
    const Interval box = clip(ray, {Vec3d(-1), Vec3d(1)});
    const MediumPtr spikes = voxels(16, spiky, coefficients(Vec3d(1), Vec3d(1)));
    const std::pair<MediumPtr, int> cases[] = {
        {two_blocks, 16}, {rough, 24}, {even, 0}, {spikes, 16}};
    for (const auto& [medium, n] : cases) {
        const auto depth = [&, &volume = *medium, voxels = n](double t) {
            const double length = voxels > 0 ? by_quadrature(volume, voxels, ray, t)
                                             : std::clamp(t, box.t0, box.t1) - box.t0;
            return double(volume.strength()) * length;
        };
        const Medium* media[] = {medium.get()};
        Tracker tracker;
        tracker.media = media;
        const double all = 1 - std::exp(-depth(9));
        ASSERT_GT(all, 0.1);
        constexpr int bins = 20, flights = 40'000;
        std::vector<int> seen(bins + 1);
        for (int i = 0; i < flights; ++i) {
            RandomStream random{random_key(17, static_cast<std::uint64_t>(i))};
            PathWeight weight;
            Collision end;
            if (!tracker.fly(ray, 0, weight, random, end)) {
                ++seen[bins];
                continue;
            }
            EXPECT_EQ(weight.weight, Vec3f(1));
            const double share = (1 - std::exp(-depth(end.t))) / all;
            ++seen[static_cast<std::size_t>(std::clamp(share * bins, 0.0, bins - 0.5))];
        }
        double chi2 = 0;
        for (int b = 0; b <= bins; ++b) {
            const double expected = flights * (b < bins ? all / bins : 1 - all);
            if (expected < 1e-6 && seen[static_cast<std::size_t>(b)] == 0) continue;
            chi2 += std::pow(seen[static_cast<std::size_t>(b)] - expected, 2) / expected;
        }
        // The 1e-4 quantile of chi-squared by Wilson and Hilferty 1931.
        const double v = 2 / (9.0 * bins), limit = bins * std::pow(1 - v + 3.719 * std::sqrt(v), 3);
        EXPECT_LT(chi2, limit);
    }
}

// In each stretch and channel the mean weight of the collisions is the integral of transmittance
// times extinction there, with any channel as hero, by medium.
TEST(PathTracking, FlightsOfManyColorsAndMediaWeighWhatTheyShould) {
    const MediumPtr one = voxels(24, wild, coefficients({0.5, 1, 3}, Vec3d(1)));
    const MediumPtr soft_two = voxels(16, soft, coefficients({2, 1, 0}, Vec3d(1)));
    const MediumPtr spiky_two = voxels(16, spiky, coefficients({2, 1, 0}, Vec3d(1)));
    const int cells[] = {24, 16};
    constexpr int bins = 6, rays = 8;
    for (std::uint64_t r = 0; r < rays; ++r) {
        const MediumPtr& two = r % 2 == 0 ? soft_two : spiky_two;
        const Medium* media[] = {one.get(), two.get()};
        const Ray ray = random_ray(40 + r / 2);
        Tracker tracker;
        tracker.media = media;
        tracker.is_grey = false;
        const auto depth = [&](double t) {
            return by_quadrature(*one, cells[0], ray, t) * Vec3d(0.5, 1, 3) +
                   by_quadrature(*two, cells[1], ray, t) * Vec3d(2, 1, 0);
        };
        for (int bin = 0; bin < bins; ++bin) {
            const double t0 = 3 + 2.0 * bin / bins, t1 = 3 + 2.0 * (bin + 1) / bins;
            const Estimate got = estimate(8000, [&](int n) {
                RandomStream random{random_key(9, r, static_cast<std::uint64_t>(n))};
                PathWeight weight;
                Collision end;
                const int hero = n % 3;
                if (!tracker.fly(ray, hero, weight, random, end) || end.t < t0 || end.t >= t1) {
                    return Vec3d{};
                }
                return Vec3d(weight.value());
            });
            for (int c = 0; c < 3; ++c) {
                const double expected = std::exp(-depth(t0)[c]) - std::exp(-depth(t1)[c]);
                if (expected < 0.01) continue;  // too rare to tell
                expect_mean(got, c, expected, 3 * bins * rays,
                            fmt::format("ray {} bin {} channel {}", r, bin, c), 1e-5);
            }
        }
    }
}

// Work does not grow with the density of what is passed by, nor of what is flown into.
TEST(PathTracking, WorkIsBoundedWhateverTheDensity) {
    for (const double most : {1e3, 1e8, 1e29}) {
        const MediumPtr medium = voxels(
            16, [most](const Vec3d& p) { return spiky(p) > 1 ? most : soft(p); },
            coefficients({1, 4, 8}, Vec3d(1)));
        const Medium* media[] = {medium.get()};
        Tracker tracker;
        tracker.media = media;
        tracker.is_grey = false;
        constexpr int rays = 300;
        for (std::uint64_t i = 0; i < rays; ++i) {
            RandomStream random{random_key(3, i)};
            PathWeight weight;
            Collision end;
            tracker.fly(random_ray(i), static_cast<int>(i % 3), weight, random, end);
            EXPECT_TRUE(std::isfinite(max_component(weight.value())));
            for (const auto kind :
                 {TransmittanceEstimator::Ratio, TransmittanceEstimator::ResidualRatio,
                  TransmittanceEstimator::Exact}) {
                const Vec3f t = tracker.transmittance(random_ray(i), kind, random);
                EXPECT_TRUE(min_component(t) >= 0 && max_component(t) <= 2) << t.x << " " << most;
            }
        }
        // A ray passes some 5 bricks and 10 blocks, of at most 64 + 3 * 20 and 32 + 22 each, and
        // may end up in one that it is cut finer in.
        EXPECT_LT(tracker.lookups, rays * (5 * 124 + 3 * 10 * 54)) << most;
    }
}

// What one channel does not see at all has no end for a flight that is drawn in it.
TEST(PathTracking, FogWithoutEndIsPassedInAClearChannel) {
    const MediumPtr fog = solid(Region::everywhere(), coefficients({1, 2, 0}, {}));
    const Medium* media[] = {fog.get()};
    Tracker tracker;
    tracker.media = media;
    tracker.is_grey = false;
    for (int i = 0; i < 100; ++i) {
        RandomStream random{random_key(4, static_cast<std::uint64_t>(i))};
        PathWeight weight;
        Collision end;
        EXPECT_FALSE(tracker.fly({{}, {0, 0, 1}}, 2, weight, random, end));
        EXPECT_EQ(weight.value(), Vec3f(0, 0, 3));
    }
}

}  // namespace
}  // namespace gischt
