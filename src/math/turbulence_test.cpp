// SPDX-License-Identifier: Apache-2.0
#include "math/turbulence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "math/noise.h"
#include "math/statistics.h"

namespace gischt {
namespace {

constexpr TurbulenceKind every_kind[] = {TurbulenceKind::Fbm, TurbulenceKind::Billow,
                                         TurbulenceKind::Ridged, TurbulenceKind::Cells,
                                         TurbulenceKind::Walls};

struct Place {
    Vec3d p;
    double w;
};

// Independent: each in a lattice cell of its own, as far as a box of 2000^3 cells allows.
Place random_place(std::uint64_t i) {
    const auto u = [&](std::uint32_t d) {
        return 2000 * static_cast<double>(random_uniform(random_key(41, i), d)) +
               static_cast<double>(random_uniform(random_key(42, i), d));
    };
    return {{u(0), u(1), u(2)}, u(3)};
}

TEST(GradientNoise4, IsZeroAtLatticePointsAndBounded) {
    RunningStatistics s;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        const Place at = random_place(i);
        const double n = static_cast<double>(gradient_noise(at.p, at.w, 7));
        ASSERT_LE(std::abs(n), std::sqrt(3.0));
        s.add(n);
        if (i % 100 == 0) {
            ASSERT_EQ(gradient_noise(Vec3d(floor(at.p)), std::floor(at.w), 7), 0);
        }
    }
    // Five standard errors: a true mean of 0 fails once in 1.7 million seeds.
    EXPECT_LT(std::abs(s.mean), 5 * s.standard_error());
    // 0.0857 by integration; the standard error of a variance is below var sqrt(3 / n) here.
    EXPECT_NEAR(s.variance(), 0.0857, 5 * 0.0857 * std::sqrt(3e-5));
}

// Value and first derivative from both sides of a lattice plane, along each of the four axes.
TEST(GradientNoise4, IsSmoothAcrossLatticePlanes) {
    constexpr double e = 1e-3;
    for (std::uint64_t i = 0; i < 200; ++i) {
        for (int axis = 0; axis < 4; ++axis) {
            Place at = random_place(i);
            (axis < 3 ? at.p[axis] : at.w) = std::floor(axis < 3 ? at.p[axis] : at.w);
            const auto n = [&](double step) {
                Place q = at;
                (axis < 3 ? q.p[axis] : q.w) += step;
                return static_cast<double>(gradient_noise(q.p, q.w, 7));
            };
            // Second derivatives are 0 at the planes but for the linear terms; third ones are about
            // 100, and a float has 1e-7: slopes agree to some 1e-3.
            const double before = (n(0) - n(-e)) / e, after = (n(e) - n(0)) / e;
            ASSERT_NEAR(before, after, 5e-3) << i << " axis " << axis;
        }
    }
}

TEST(CellDistances, AreThoseOfTheNearestPointsAndOrdered) {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Place at = random_place(i);
        const CellDistances d = cell_distances(at.p, at.w, 3);
        ASSERT_GE(d.first, 0);
        ASSERT_LE(d.first, d.second);
        ASSERT_LE(d.first, std::sqrt(3.0f));  // a point is in the cell itself
        // Distances are 1-Lipschitz: a step of s changes none by more than s.
        const CellDistances near = cell_distances(at.p + Vec3d(0.03, -0.04, 0.12), at.w, 3);
        ASSERT_NEAR(d.first, near.first, 0.1301f);
        ASSERT_NEAR(d.second, near.second, 0.1301f);
    }
}

TEST(Turbulence, HasMeanZeroAndUnitVarianceInEveryKind) {
    for (const TurbulenceKind kind : every_kind) {
        for (const int octaves : {1, 5}) {
            const Turbulence t({.kind = kind, .octaves = octaves, .seed = 9});
            RunningStatistics s;
            for (std::uint64_t i = 0; i < 20000; ++i) {
                const Place at = random_place(i);
                const double v = t.value(at.p, at.w);
                ASSERT_LE(v, t.most());
                ASSERT_GE(v, t.least());
                s.add(v);
            }
            // The constants have 1 %; five standard errors of 20000 points are 0.035. Octaves
            // share the sign of the constants' error, which their weights add up to 1.7.
            EXPECT_NEAR(s.mean, 0, 0.05) << static_cast<int>(kind) << " " << octaves;
            EXPECT_NEAR(s.variance(), 1, 0.07) << static_cast<int>(kind) << " " << octaves;
        }
    }
}

// The variance of octave n is gain^(2n) that of the first: the structure function at a distance
// that decorrelates all octaves is twice the variance, and at a small one it grows as the square of
// the distance times sum (gain lacunarity)^(2n).
TEST(Turbulence, HasTheSpectrumOfItsGainAndLacunarity) {
    constexpr double step = 1e-3;
    const auto slope = [&](double gain, int octaves) {
        const Turbulence t({.octaves = octaves, .gain = gain});
        RunningStatistics s;
        for (std::uint64_t i = 0; i < 40000; ++i) {
            const Place at = random_place(i);
            const double d = (t.value(at.p + Vec3d(step, 0, 0), at.w) - t.value(at.p, at.w)) / step;
            s.add(d * d);
        }
        return s.mean;
    };
    const double one = slope(0.5, 1);
    for (const double gain : {0.35, 0.5, 0.7}) {
        const double ratio = 4 * gain * gain, share = gain * gain;
        const double expected = one * (1 + ratio + ratio * ratio) / (1 + share + share * share);
        EXPECT_NEAR(slope(gain, 3) / expected, 1, 0.04) << gain;
    }
}

TEST(Turbulence, IsAFunctionOfItsSeed) {
    const Turbulence a({.seed = 1}), again({.seed = 1}), other({.seed = 2});
    double product = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        const Place at = random_place(i);
        ASSERT_EQ(a.value(at.p, at.w), again.value(at.p, at.w));
        product += a.value(at.p, at.w) * other.value(at.p, at.w) / 4000;
    }
    EXPECT_LT(std::abs(product), 5 / std::sqrt(4000.0));  // uncorrelated
}

// Smaller features change faster: the correlation after w = 0.1 falls with each octave added.
TEST(Turbulence, ChangesContinuouslyInTimeAndForgets) {
    const auto correlation = [](double w, int octaves) {
        const Turbulence t({.octaves = octaves, .gain = 0.8});
        double sum = 0;
        for (std::uint64_t i = 0; i < 10000; ++i) {
            const Place at = random_place(i);
            sum += t.value(at.p, at.w) * t.value(at.p, at.w + w) / 10000;
        }
        return sum;
    };
    EXPECT_NEAR(correlation(0.001, 4), 1, 0.06);
    EXPECT_LT(correlation(0.3, 4), correlation(0.3, 1) - 0.05);
    EXPECT_LT(std::abs(correlation(3, 4)), 0.05);
}

TEST(Turbulence, SparesOnlyOctavesThatDoNotMatter) {
    const Turbulence t({.octaves = 6});
    for (std::uint64_t i = 0; i < 5000; ++i) {
        const Place at = random_place(i);
        const double v = t.value(at.p, at.w), within = t.value_within(at.p, at.w, 0.5, 1.0);
        ASSERT_NEAR(std::clamp(v, 0.5, 1.0), std::clamp(within, 0.5, 1.0), 1e-12);
    }
}

TEST(Turbulence, RefusesWhatIsNoSpectrum) {
    EXPECT_THROW(Turbulence({.octaves = 0}), Error);
    EXPECT_THROW(Turbulence({.lacunarity = 1}), Error);
    EXPECT_THROW(Turbulence({.gain = -0.1}), Error);
}

TEST(Warped, MovesPointsByTheStatedDeviation) {
    RunningStatistics s;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const Place at = random_place(i);
        s.add((warped(at.p, at.w, 0.4, 5) - at.p).y);
    }
    EXPECT_NEAR(s.variance(), 0.16, 0.16 * 0.06);
    EXPECT_NEAR(s.mean, 0, 0.015);
}

}  // namespace
}  // namespace gischt
