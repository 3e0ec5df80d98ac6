// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/primary_numbers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gischt {
namespace {

TEST(PrimaryNumbers, ComeBackWhenAProposalIsRejected) {
    PrimaryNumbers numbers(5);
    std::vector<float> before;
    for (std::size_t i = 0; i < 20; ++i) before.push_back(numbers.at(i % 3, i));
    numbers.mutate_by(7, 0.05);
    for (int m = 0; m < 40; ++m) {
        if (m % 5 == 1) {
            numbers.propose_track(1);
        } else {
            numbers.propose(m % 3 == 0);
        }
        int moved = 0;
        for (std::size_t i = 0; i < 20; i += 2) moved += numbers.at(i % 3, i) != before[i];
        numbers.reject();
        // Every other number lies in each of three tracks: 3 in the second.
        EXPECT_EQ(moved, m % 5 == 1 ? 3 : 10) << m;
    }
    for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(numbers.at(i % 3, i), before[i]) << i;
}

// A number that was not looked at moves as if it had been.
TEST(PrimaryNumbers, MakeUpForMutationsThatTheyMissed) {
    constexpr int chains = 20'000, steps = 9;
    constexpr double sigma = 0.01;
    double squares[2] = {};
    for (int c = 0; c < chains; ++c) {
        PrimaryNumbers numbers(static_cast<std::uint64_t>(c));
        const float seen = numbers.at(0, 0), unseen = numbers.at(1, 0);
        numbers.mutate_by(static_cast<std::uint64_t>(c) + 1'000'000, sigma);
        for (int m = 0; m < steps; ++m) {
            numbers.propose(false);
            numbers.at(0, 0);
            if (m == 3 || m == 5) {  // rejected ones do not count
                numbers.reject();
            } else {
                numbers.accept();
            }
        }
        const auto off = [](float a, float b) {
            const double d = static_cast<double>(a) - static_cast<double>(b);
            return d - std::round(d);
        };
        squares[0] += std::pow(off(numbers.at(0, 0), seen), 2);
        squares[1] += std::pow(off(numbers.at(1, 0), unseen), 2);
    }
    // A variance from n normal numbers has the relative error sqrt(2 / n): 1 %, five times that.
    for (const double s : squares) {
        EXPECT_NEAR(s / chains / (sigma * sigma * (steps - 2)), 1, 0.05);
    }
}

// Whatever is accepted at random, uniform numbers stay uniform.
TEST(PrimaryNumbers, StayUniform) {
    constexpr int bins = 16, chains = 16'000;
    std::array<int, bins> count{};
    for (int c = 0; c < chains; ++c) {
        PrimaryNumbers numbers(static_cast<std::uint64_t>(c));
        numbers.mutate_by(static_cast<std::uint64_t>(c) + 77'000'000, 0.2);
        for (int m = 0; m < 6; ++m) {
            numbers.propose(m == 2);
            numbers.at(0, 0);
            if (random_uniform(3, static_cast<std::uint32_t>(6 * c + m)) < 0.6f) {
                numbers.accept();
            } else {
                numbers.reject();
            }
        }
        ++count[static_cast<std::size_t>(numbers.at(0, 0) * bins)];
    }
    double chi2 = 0;
    for (const int n : count) chi2 += std::pow(n - 1000.0, 2) / 1000;
    EXPECT_LT(chi2, 37.7);  // 15 degrees of freedom, one failure in a thousand
}

}  // namespace
}  // namespace gischt
