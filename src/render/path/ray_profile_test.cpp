// SPDX-License-Identifier: Apache-2.0
// The walk through media and the profile along a camera ray.
#include "render/path/ray_profile.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "optics/layer.h"
#include "render/path/test_views.h"
#include "render/path/tracking.h"

namespace gischt {
namespace {

using namespace path_test;

// Three media that overlap in part, their albedo 0.5 in all channels.
struct Overlap {
    MediumPtr a = voxels(
        16, [](const Vec3d& p) { return lumps(p); }, coefficients({1, 2, 4}, Vec3d(0.5)));
    MediumPtr b = voxels(
        24, [](const Vec3d& p) { return 3 * lumps(p + Vec3d(0.4), 5); },
        coefficients({2, 1, 0}, Vec3d(0.5)));
    MediumPtr c =
        solid(Region::sphere({0.2, 0.3, 0}, 0.9), coefficients({0.5, 0.3, 0.7}, Vec3d(0.5)));
    std::vector<const Medium*> media{a.get(), b.get(), c.get()};
};

Ray random_ray(std::uint64_t i) {
    const auto u = [i](std::uint32_t d) {
        return 2 * double(random_uniform(random_key(77, i), d)) - 1;
    };
    const Vec3d through(0.6 * u(0), 0.6 * u(1), 0.6 * u(2));
    const Vec3d direction = normalize(Vec3d(u(3), u(4), u(5)));
    return {through - 4 * direction, direction};
}

TEST(MediaWalk, RunsCoverWhatTheMediaCoverAlone) {
    const Overlap o;
    for (std::uint64_t i = 0; i < 100; ++i) {
        const Ray ray = random_ray(i);
        for (const BrickGrain grain : {BrickGrain::Blocks, BrickGrain::Bricks}) {
            MediaWalk walk(o.media, ray, grain);
            MediaRun run;
            double before = ray.t_min;
            std::vector<double> covered(3);
            while (walk.next(run)) {
                EXPECT_GE(run.t0, before);
                ASSERT_GT(run.t1, run.t0);
                before = run.t1;
                for (const ActiveMedium& a : run.active) covered[a.index] += run.t1 - run.t0;
                // The bounds hold in the middle and near the ends.
                for (const double s : {0.01, 0.5, 0.99}) {
                    const double t = run.t0 + s * (run.t1 - run.t0);
                    const float extinction = max_component(extinction_at(run, t));
                    EXPECT_LE(extinction, run.max * (1 + 1e-5f));
                    const float expected =
                        max_component(o.a->density(ray.at(t)) * o.a->cross_sections().extinction() +
                                      o.b->density(ray.at(t)) * o.b->cross_sections().extinction() +
                                      o.c->density(ray.at(t)) * o.c->cross_sections().extinction());
                    EXPECT_NEAR(extinction, expected, 1e-4f * expected + 1e-5f);
                }
            }
            for (std::size_t m = 0; m < 3; ++m) {
                double alone = 0;
                SegmentWalk segments = o.media[m]->segments(ray, grain);
                MediumSegment s;
                while (segments.next(s)) alone += s.t1 - s.t0;
                EXPECT_NEAR(covered[m], alone, 1e-9) << "ray " << i << " medium " << m;
            }
        }
    }
}

TEST(RayProfile, ItsDepthIsTheExactOne) {
    const Overlap o;
    Tracker tracker;
    tracker.media = o.media;
    RayProfile profile;
    for (std::uint64_t i = 0; i < 100; ++i) {
        const Ray ray = random_ray(i);
        std::int64_t lookups = 0;
        profile.trace(o.media, ray, false, lookups);
        const Vec3f expected = tracker.exact_depth(ray);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(profile.depth()[c], expected[c], 1e-5f * expected[c] + 1e-6f);
        }
    }
}

// Over a fog without a grid, which no two points integrate without error.
TEST(RayProfile, SeesThroughLayers) {
    const Layer layer = Layer::flat({0, 0, 1}, 0, {HeightProfile::Kind::Exponential, 3, 0}, 40);
    const Medium fog(layer, coefficients(Vec3d(0.1), Vec3d(0.5)), 0);
    const Medium* media[] = {&fog};
    for (const double slope : {1.0, 0.1, -0.2}) {
        const Ray ray{{0, 0, 8}, normalize(Vec3d(1, 0, slope)), 0, 60};
        RayProfile profile;
        std::int64_t lookups = 0;
        profile.trace(media, ray, true, lookups);
        const double expected = 0.1 * layer.column(ray);
        EXPECT_NEAR(double(profile.depth().x) / expected, 1, 1e-4) << slope;
        EXPECT_NEAR(0.1 * exact_density_integral(fog, ray, lookups) / expected, 1, 1e-4) << slope;
    }
}

// Twenty bins of equal probability, each point of a ray stratified by itself.
TEST(RayProfile, PointsFollowTheDensityTheyTell) {
    const Overlap o;
    for (const bool is_grey : {true, false}) {
        const std::vector<const Medium*> media =
            is_grey ? std::vector<const Medium*>{o.c.get()} : o.media;
        const Ray ray = random_ray(3);
        RayProfile profile;
        std::int64_t lookups = 0;
        profile.trace(media, ray, is_grey, lookups);
        // The cumulative of density(t), by the midpoint rule.
        constexpr int fine = 40'000;
        constexpr double from = 2, to = 6;
        std::vector<double> below(fine + 1);
        for (int i = 0; i < fine; ++i) {
            const double t = from + (to - from) * (i + 0.5) / fine;
            below[static_cast<std::size_t>(i) + 1] =
                below[static_cast<std::size_t>(i)] +
                (to - from) / fine * double(profile.density(t));
        }
        EXPECT_NEAR(below.back(), 1, 2e-4);
        constexpr int bins = 20, count = 40'000;
        std::vector<double> seen(bins);
        std::vector<ProfilePoint> points;
        for (int i = 0; i < count; ++i) {
            const std::uint64_t key = random_key(5, static_cast<std::uint64_t>(i));
            points.clear();
            profile.points(1, random_uniform(key, 0), random_uniform(key, 1), points, lookups);
            ASSERT_EQ(points.size(), 1U);
            const double place = (points[0].t - from) / (to - from) * fine;
            const double share =
                below[static_cast<std::size_t>(std::clamp(place, 0.0, 1.0 * fine))];
            ++seen[static_cast<std::size_t>(std::clamp(share * bins, 0.0, bins - 0.5))];
        }
        double chi2 = 0;
        for (const double n : seen) chi2 += std::pow(n - 1.0 * count / bins, 2) * bins / count;
        const double n = bins - 1, v = 2 / (9 * n),
                     limit = n * std::pow(1 - v + 3.719 * std::sqrt(v), 3);
        EXPECT_LT(chi2, limit) << is_grey;
    }
}

// With albedo 0.5 the weights of all points sum up to half of what is not transmitted, in all
// channels, and those of each medium to its part of the extinction seen.
TEST(RayProfile, WeightsSumUpToTheOpacity) {
    const Overlap o;
    const std::vector<std::vector<const Medium*>> sets{
        o.media, {o.a.get()}, {o.b.get()}, {o.c.get()}, {o.b.get(), o.a.get()}};
    constexpr int rays = 4;
    for (const auto& media : sets) {
        for (std::uint64_t r = 0; r < rays; ++r) {
            const Ray ray = random_ray(r);
            RayProfile profile;
            std::int64_t lookups = 0;
            profile.trace(media, ray, false, lookups);
            // Medium 0's part by a fine sum over its density.
            Vec3d part;
            constexpr int fine = 4000;
            std::vector<ProfilePoint> points;
            Vec3d depth;
            for (int i = 0; i < fine; ++i) {
                const double h = 4.0 / fine;
                const Vec3d point = ray.at(2 + (i + 0.5) * h);
                Vec3d extinction;
                for (const Medium* m : media) {
                    extinction += h * Vec3d(m->density(point) * m->cross_sections().extinction());
                }
                depth += 0.5 * extinction;
                part += 0.5 * h *
                        Vec3d(std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)) *
                        Vec3d(media[0]->density(point) * media[0]->cross_sections().extinction());
                depth += 0.5 * extinction;
            }
            for (const int n : {1, 3, 4}) {
                std::vector<Vec3d> all(2000), first(2000);
                for (std::size_t i = 0; i < all.size(); ++i) {
                    const std::uint64_t key = random_key(6, i, r);
                    points.clear();
                    profile.points(n, random_uniform(key, 0), random_uniform(key, 1), points,
                                   lookups);
                    for (const ProfilePoint& p : points) {
                        all[i] += Vec3d(p.weight);
                        if (p.medium == 0) first[i] += Vec3d(p.weight);
                    }
                }
                const auto value = [](const std::vector<Vec3d>& v) {
                    return [&v](int i) { return v[static_cast<std::size_t>(i)]; };
                };
                const Estimate sum = estimate(2000, value(all)),
                               of_first = estimate(2000, value(first));
                const std::string name =
                    fmt::format("{} media, ray {}, {} points", media.size(), r, n);
                for (int c = 0; c < 3; ++c) {
                    const double opacity = 1 - std::exp(-double(profile.depth()[c]));
                    expect_mean(sum, c, 0.5 * opacity, 5 * rays * 18, name, 2e-5);
                    expect_mean(of_first, c, part[c], 5 * rays * 18, name + ", the first", 1e-3);
                }
            }
        }
    }
}

// However thick the cells, no point weighs much more than its share: a density that is a cubic, and
// not below zero, is at most 4 times its mean, and halves of a piece that differ by no more than an
// optical depth of 1/4 bend its transmittance by less than exp(1/2).
TEST(RayProfile, PointsInThickCellsWeighAlike) {
    const auto grain = [](const Vec3d& p) {
        const auto cell = [](double x) { return static_cast<std::uint64_t>((x + 1) * 8); };
        const std::uint64_t key = random_key(2, cell(p.x), cell(p.y), cell(p.z));
        return std::pow(10, 6 * double(random_uniform(key, 0)) - 2);
    };
    const MediumPtr rough = voxels(16, grain, coefficients(Vec3d(1), Vec3d(1)));
    const Medium* media[] = {rough.get()};
    RayProfile profile;
    std::int64_t lookups = 0;
    constexpr int n = 64, rays = 200;
    for (std::uint64_t i = 0; i < rays; ++i) {
        profile.trace(media, random_ray(i), true, lookups);
        const double opacity = 1 - std::exp(-double(profile.depth().x));
        const double bound = 4 * std::exp(0.5) * opacity / n;
        std::vector<ProfilePoint> points;
        profile.points(n, random_uniform(3, static_cast<std::uint32_t>(i)), 0.5f, points, lookups);
        double sum = 0;
        for (const ProfilePoint& p : points) {
            EXPECT_LE(double(p.weight.x), bound * (1 + 1e-4)) << i;
            sum += double(p.weight.x);
        }
        // Stratified: off by a few points' weights at most.
        EXPECT_NEAR(sum, opacity, 6 * bound) << i;
    }
}

}  // namespace
}  // namespace gischt
