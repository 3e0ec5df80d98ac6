// SPDX-License-Identifier: Apache-2.0
#include "image/filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "math/quadrature.h"

namespace gischt {
namespace {

constexpr FilterKind all_kinds[] = {FilterKind::Box, FilterKind::Gaussian, FilterKind::Mitchell,
                                    FilterKind::BlackmanHarris};

FilterSample random_sample(const ReconstructionFilter& filter, std::uint64_t i) {
    const std::uint64_t key = random_key(3, i);
    return filter.sample({random_uniform(key, 0), random_uniform(key, 1)});
}

TEST(Filter, KnowsItsNames) {
    EXPECT_EQ(filter_kind("mitchell"), FilterKind::Mitchell);
    EXPECT_THROW(filter_kind("mitchel"), Error);
    EXPECT_THROW(ReconstructionFilter(FilterKind::Box, 20), Error);
}

// Published values: Mitchell & Netravali's cubic is 16/18 at 0, 1/18 at 1 and 0 at 2, and its
// integral is 1. The Blackman-Harris window is 1 at 0 and 6e-5 at its ends.
TEST(Filter, ProfilesHaveTheirPublishedValues) {
    const ReconstructionFilter mitchell(FilterKind::Mitchell), harris(FilterKind::BlackmanHarris);
    EXPECT_NEAR(mitchell.profile(0), 16.0 / 18, 1e-12);
    EXPECT_NEAR(mitchell.profile(1), 1.0 / 18, 1e-12);
    EXPECT_NEAR(mitchell.profile(-2), 0, 1e-12);
    EXPECT_NEAR(harris.profile(0), 1, 1e-12);
    EXPECT_NEAR(harris.profile(1.5), 6e-5, 1e-9);
    const GaussLegendre rule(8);
    auto f = [&](double x) { return mitchell.profile(x); };
    EXPECT_NEAR(2 * (rule.integrate(0, 1, f) + rule.integrate(1, 2, f)), 1, 1e-12);
}

// Mean offset 0 within five standard errors, and the variance of the profile.
TEST(Filter, SamplesHaveTheMomentsOfTheFilter) {
    for (const FilterKind kind : all_kinds) {
        const ReconstructionFilter filter(kind);
        const int n = 200000;
        double x = 0, xx = 0, w = 0;
        for (int i = 0; i < n; ++i) {
            const FilterSample s = random_sample(filter, static_cast<std::uint64_t>(i));
            x += s.offset.x;
            xx += s.weight * s.offset.x * s.offset.x;
            w += s.weight;
        }
        const GaussLegendre rule(64);
        const double r = filter.radius();
        const double net = rule.integrate(-r, r, [&](double t) { return filter.profile(t); });
        const double second =
            rule.integrate(-r, r, [&](double t) { return t * t * filter.profile(t); }) / net;
        const double error = 5 * r / std::sqrt(n);
        EXPECT_NEAR(x / n, 0, error);
        EXPECT_NEAR(xx / w, second, error * r);
        EXPECT_NEAR(w / n, filter.mean_weight(), 5 / std::sqrt(n));
    }
}

// Chi-squared over 20 x 20 bins against |f|, at the 99.99 % quantile (Wilson & Hilferty 1931).
TEST(Filter, SamplesFollowTheDensity) {
    constexpr int side = 20, n = 400000;
    for (const FilterKind kind : all_kinds) {
        const ReconstructionFilter filter(kind);
        const double r = filter.radius();
        std::vector<double> share(side), seen(side * side);
        const GaussLegendre rule(32);
        double total = 0;
        for (int i = 0; i < side; ++i) {
            const double a = -r + 2 * r * i / side, b = a + 2 * r / side;
            const double s =
                rule.integrate(a, b, [&](double t) { return std::abs(filter.profile(t)); });
            total += share[static_cast<std::size_t>(i)] = s;
        }
        auto bin = [&](float x) {
            return std::min(static_cast<int>((x + r) / (2 * r) * side), side - 1);
        };
        for (int i = 0; i < n; ++i) {
            const FilterSample s = random_sample(filter, static_cast<std::uint64_t>(i));
            seen[static_cast<std::size_t>(bin(s.offset.y) * side + bin(s.offset.x))] += 1;
        }
        double chi = 0, rare_expected = 0, rare_seen = 0;
        int degrees = -1;
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const double expected = n * share[k / side] * share[k % side] / (total * total);
            if (expected < 5) {
                rare_expected += expected;
                rare_seen += seen[k];
                continue;
            }
            chi += (seen[k] - expected) * (seen[k] - expected) / expected;
            ++degrees;
        }
        if (rare_expected > 5) {
            chi += (rare_seen - rare_expected) * (rare_seen - rare_expected) / rare_expected;
            ++degrees;
        }
        const double q = 2.0 / (9.0 * degrees);
        EXPECT_LT(chi, degrees * std::pow(1 - q + 3.72 * std::sqrt(q), 3))
            << static_cast<int>(kind);
    }
}

TEST(Filter, KeepsTheOrderOfItsNumbers) {
    const ReconstructionFilter filter;
    float last = -filter.radius();
    for (int i = 0; i < 1000; ++i) {
        const float x = filter.sample({static_cast<float>(i) / 1000, 0.5f}).offset.x;
        EXPECT_GE(x, last);
        last = x;
    }
    EXPECT_LE(last, filter.radius());
}

}  // namespace
}  // namespace gischt
