// SPDX-License-Identifier: Apache-2.0
#include "optics/phase.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "math/quadrature.h"
#include "math/sobol.h"

namespace gischt {
namespace {

PhaseParams mie(double diameter) {
    return {.kind = PhaseKind::Mie, .droplet_diameter = diameter};
}
const PhaseParams cases[] = {
    {PhaseKind::Isotropic, 0},
    {PhaseKind::HenyeyGreenstein, 0},
    {PhaseKind::HenyeyGreenstein, 1e-4},
    {PhaseKind::HenyeyGreenstein, 0.5},
    {PhaseKind::HenyeyGreenstein, -0.6},
    {PhaseKind::HenyeyGreenstein, 0.877},
    {PhaseKind::Schlick, 0},
    {PhaseKind::Schlick, 0.01},
    {PhaseKind::Schlick, 0.5},
    {PhaseKind::Schlick, -0.7},
    {PhaseKind::Schlick, 0.85},
    {PhaseKind::Rayleigh, 0},
    {.kind = PhaseKind::TwoLobe, .g = 0.85, .g2 = -0.4, .lobe_weight = 0.7},
    {.kind = PhaseKind::TwoLobe, .g = 0.3, .g2 = 0.9, .lobe_weight = 0},
    {.kind = PhaseKind::TwoLobe, .g = 0.3, .g2 = 0.9, .lobe_weight = 1},
    mie(0.01),
    mie(0.06),
    mie(0.1),
    mie(0.3),
    mie(0.6),
    mie(1),
    mie(1.5),
    mie(4.9),
    mie(5),
    mie(10),
    mie(20),
    mie(50),
};

std::string named(const PhaseParams& p) {
    return "kind " + std::to_string(int(p.kind)) + " g " + std::to_string(p.g) + " diameter " +
           std::to_string(p.droplet_diameter);
}

// Integral of f(cosine) over the sphere between two angles, in 60 panels that get finer towards the
// first.
template <class F>
double over_angles(double from, double to, F&& f) {
    static const GaussLegendre rule(12);
    double sum = 0;
    const auto edge = [&](int panel) { return from + (to - from) * std::pow(panel / 60.0, 3); };
    for (int panel = 0; panel < 60; ++panel) {
        sum += rule.integrate(edge(panel), edge(panel + 1),
                              [&](double t) { return std::sin(t) * f(std::cos(t)); });
    }
    return 2 * pi * sum;
}

TEST(Phase, IntegratesToOneWithTheStatedMeanCosine) {
    for (const PhaseParams& c : cases) {
        const PhaseFunction phase = make_phase(c);
        const auto p = [&](double x) { return double(value(phase, static_cast<float>(x))); };
        // The peak of large droplets is (1 - g)^2 / 2 wide in the cosine, down to 2e-6, of which a
        // float's step is 3 %: the error is of second order in that.
        const bool is_large = c.kind == PhaseKind::Mie && c.droplet_diameter > 10;
        const double tolerance = is_large ? 3e-4 : c.kind == PhaseKind::Mie ? 1e-5 : 1e-6;
        EXPECT_NEAR(over_angles(0, pi, p), 1, tolerance) << named(c);
        const double mean = over_angles(0, pi, [&](double x) { return x * p(x); });
        EXPECT_NEAR(mean, mean_cosine(phase), tolerance) << named(c);
        // Schlick's k resembles Henyey-Greenstein; its mean is near g, not equal.
        if (c.kind <= PhaseKind::Schlick) {
            EXPECT_NEAR(mean, c.g, c.kind == PhaseKind::Schlick ? 0.12 : 1e-6);
        }
    }
}

// The table of the reference values: cosines -1, 0, 1.
TEST(Phase, MeetsPublishedValues) {
    const auto expect = [](PhaseKind kind, double g, std::array<double, 3> published) {
        const PhaseFunction phase = make_phase(kind, g);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(value(phase, float(i - 1)), published[size_t(i)], 3e-6) << g << " " << i;
        }
    };
    expect(PhaseKind::HenyeyGreenstein, 0.5, {0.017684, 0.042706, 0.477465});
    expect(PhaseKind::HenyeyGreenstein, 0.85, {0.003488, 0.009768, 6.543037});
    expect(PhaseKind::Schlick, 0.75, {0.002866, 0.010682, 2.209392});
}

// Molecules of air: 1.5 and 0.75 times the isotropic value ahead and aside.
TEST(Phase, RayleighMeetsItsExtremes) {
    EXPECT_FLOAT_EQ(RayleighPhase{}.value(-1), static_cast<float>(1.5 / (4 * pi)));
    EXPECT_FLOAT_EQ(RayleighPhase{}.value(0), static_cast<float>(0.75 / (4 * pi)));
    EXPECT_FLOAT_EQ(RayleighPhase{}.sample_cosine(0), -1);
    EXPECT_EQ(RayleighPhase{}.sample_cosine(0.5f), 0);
    // 3/8 (c + c^3/3) + 1/2 at c = 1/2.
    EXPECT_NEAR(RayleighPhase{}.sample_cosine(0.703125f), 0.5, 1e-6);
}

// The mean cosine of droplets in visible light: 0.82 to 0.89 in clouds (Hu & Stamnes 1993, radii
// from 2.5 to 25 micrometres), and the limit of Rayleigh.
TEST(Phase, MieMeetsTheAsymmetryOfClouds) {
    for (const double diameter : {5.0, 8.0, 12.0, 20.0, 35.0, 50.0}) {
        const double mean = mean_cosine(make_phase(mie(diameter)));
        EXPECT_GT(mean, 0.81) << diameter;
        EXPECT_LT(mean, 0.895) << diameter;
    }
    const PhaseFunction tiny = make_phase(mie(0.01));
    for (const float cosine : {-1.0f, -0.5f, 0.0f, 0.5f, 1.0f}) {
        EXPECT_NEAR(value(tiny, cosine) / RayleighPhase{}.value(cosine), 1, 0.02) << cosine;
    }
}

// The parts of the fit meet where its ranges do, as far as the paper's own fit does.
TEST(Phase, MieIsContinuousInTheDiameter) {
    for (const double diameter : {0.1, 1.5, 5.0}) {
        const PhaseFunction below = make_phase(mie(diameter * (1 - 1e-9))),
                            above = make_phase(mie(diameter * (1 + 1e-9)));
        EXPECT_NEAR(mean_cosine(below), mean_cosine(above), 0.03) << diameter;
    }
}

TEST(Phase, IsotropicLimitIsExact) {
    const float isotropic = IsotropicPhase{}.value(0.3f);
    EXPECT_EQ(HenyeyGreensteinPhase{0}.value(0.3f), isotropic);
    EXPECT_EQ(SchlickPhase{0}.value(0.3f), isotropic);
    for (const float u : {0.0f, 0.25f, 0.8f}) {
        EXPECT_EQ(HenyeyGreensteinPhase{0}.sample_cosine(u), 2 * u - 1);
        EXPECT_NEAR(HenyeyGreensteinPhase{1e-6f}.sample_cosine(u), 2 * u - 1, 3e-6);
    }
}

TEST(Phase, RefusesAnAsymmetryOfOne) {
    EXPECT_THROW(make_phase(PhaseKind::HenyeyGreenstein, 1), Error);
    EXPECT_THROW(make_phase(PhaseKind::Schlick, -1), Error);
    EXPECT_THROW(make_phase(PhaseKind::Schlick, std::nan("")), Error);
    EXPECT_THROW(make_phase({.kind = PhaseKind::TwoLobe, .g = 0, .g2 = 1}), Error);
    EXPECT_THROW(make_phase({.kind = PhaseKind::TwoLobe, .lobe_weight = 1.5}), Error);
    for (const double diameter : {0.0, -1.0, 50.1, std::nan("")}) {
        EXPECT_THROW(make_phase(mie(diameter)), Error);
    }
}

// Light that goes the other way meets the same value: Helmholtz reciprocity, and a sample's density
// is the value between its two directions.
TEST(Phase, IsReciprocal) {
    for (const PhaseParams& c : cases) {
        const PhaseFunction phase = make_phase(c);
        const Vec3f in = normalize(Vec3f{-0.4f, 0.7f, 0.2f});
        for (int i = 0; i < 64; ++i) {
            const Vec2f u{(float(i) + 0.5f) / 64, std::fmod(float(i) * 0.618f, 1.0f)};
            const PhaseSample out = sample(phase, in, u);
            const float back = value(phase, dot(-out.direction, -in));
            // The cosine's rounding shows in the peak: the value's slope times 2e-7.
            const float slope = std::abs(value(phase, dot(out.direction, in) - 1e-5f) - back);
            EXPECT_NEAR(back, out.pdf, 1e-4f * out.pdf + 0.05f * slope) << named(c);
        }
    }
}

// Chi-squared: 200 000 independent samples in 32 x 4 fields of cosine and azimuth, cosine fields of
// equal expectation would hide errors of the inversion, so they are even in the angle; fields that
// expect fewer than 5 are joined. 99.99 % quantile by Wilson & Hilferty 1931.
TEST(Phase, SamplesHaveTheDensityOfTheValue) {
    constexpr int rows = 32, columns = 4, count = 200000;
    for (const PhaseParams& c : cases) {
        const PhaseFunction phase = make_phase(c);
        const Vec3f forward = normalize(Vec3f{0.3f, -0.5f, 0.8f});
        Vec3f s, t;
        orthonormal_frame(forward, s, t);
        std::array<double, rows * columns> seen{}, expected{};
        for (int i = 0; i < count; ++i) {
            const std::uint64_t key = random_key(7, std::uint64_t(i));
            const PhaseSample d =
                sample(phase, forward, {random_uniform(key, 0), random_uniform(key, 1)});
            ASSERT_NEAR(length(d.direction), 1, 1e-5);
            const float cosine = dot(d.direction, forward);
            const int row =
                std::min(rows - 1, int(std::acos(std::clamp(cosine, -1.0f, 1.0f)) / pi * rows));
            const double turn = std::atan2(dot(d.direction, t), dot(d.direction, s)) / (2 * pi);
            const int column = std::min(columns - 1, int((turn < 0 ? turn + 1 : turn) * columns));
            seen[size_t(row * columns + column)] += 1;
        }
        for (int row = 0; row < rows; ++row) {
            const double share =
                over_angles(pi * row / rows, pi * (row + 1) / rows,
                            [&](double x) { return double(value(phase, float(x))); }) /
                columns;
            for (int column = 0; column < columns; ++column) {
                expected[size_t(row * columns + column)] = share * count;
            }
        }
        double chi2 = 0, rest_seen = 0, rest_expected = 0;
        int fields = 0;
        for (size_t f = 0; f < seen.size(); ++f) {
            if (expected[f] < 5) {
                rest_seen += seen[f], rest_expected += expected[f];
            } else {
                chi2 += (seen[f] - expected[f]) * (seen[f] - expected[f]) / expected[f], ++fields;
            }
        }
        if (rest_expected > 5) {
            chi2 += (rest_seen - rest_expected) * (rest_seen - rest_expected) / rest_expected;
            ++fields;
        }
        const double n = fields - 1, v = 2 / (9 * n),
                     limit = n * std::pow(1 - v + 3.719 * std::sqrt(v), 3);
        EXPECT_LT(chi2, limit) << named(c);
    }
}

}  // namespace
}  // namespace gischt
