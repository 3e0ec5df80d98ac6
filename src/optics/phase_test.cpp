// SPDX-License-Identifier: Apache-2.0
#include "optics/phase.h"

#include <gtest/gtest.h>

#include <array>

#include "base/error.h"
#include "base/random.h"
#include "math/quadrature.h"
#include "math/sobol.h"

namespace gischt {
namespace {

struct Case {
    PhaseKind kind;
    double g;
};
const Case cases[] = {{PhaseKind::Isotropic, 0},
                      {PhaseKind::HenyeyGreenstein, 0},
                      {PhaseKind::HenyeyGreenstein, 1e-4},
                      {PhaseKind::HenyeyGreenstein, 0.5},
                      {PhaseKind::HenyeyGreenstein, -0.6},
                      {PhaseKind::HenyeyGreenstein, 0.877},
                      {PhaseKind::Schlick, 0},
                      {PhaseKind::Schlick, 0.01},
                      {PhaseKind::Schlick, 0.5},
                      {PhaseKind::Schlick, -0.7},
                      {PhaseKind::Schlick, 0.85}};

// Integral of f(cosine) over the sphere, in 40 panels that get finer towards both poles.
template <class F>
double over_sphere(F&& f) {
    const GaussLegendre rule(12);
    double sum = 0;
    for (int panel = 0; panel < 40; ++panel) {
        const double a = -std::cos(pi * panel / 40), b = -std::cos(pi * (panel + 1) / 40);
        sum += rule.integrate(a, b, f);
    }
    return 2 * pi * sum;
}

TEST(Phase, IntegratesToOneWithTheStatedMeanCosine) {
    for (const Case& c : cases) {
        const PhaseFunction phase = make_phase(c.kind, c.g);
        const auto p = [&](double x) { return double(value(phase, static_cast<float>(x))); };
        EXPECT_NEAR(over_sphere(p), 1, 1e-6) << c.g;
        const double mean = over_sphere([&](double x) { return x * p(x); });
        EXPECT_NEAR(mean, mean_cosine(phase), 1e-6) << c.g;
        // Schlick's k resembles Henyey-Greenstein; its mean is near g, not equal.
        EXPECT_NEAR(mean, c.g, c.kind == PhaseKind::Schlick ? 0.12 : 1e-6);
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
}

// Chi-squared: 200 000 independent samples in 32 x 4 fields of cosine and azimuth, cosine fields of
// equal expectation would hide errors of the inversion, so they are even in the angle; fields that
// expect fewer than 5 are joined. 99.99 % quantile by Wilson & Hilferty 1931.
TEST(Phase, SamplesHaveTheDensityOfTheValue) {
    constexpr int rows = 32, columns = 4, count = 200000;
    for (const Case& c : cases) {
        const PhaseFunction phase = make_phase(c.kind, c.g);
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
        const GaussLegendre rule(24);
        for (int row = 0; row < rows; ++row) {
            const double share =
                rule.integrate(std::cos(pi * (row + 1) / rows), std::cos(pi * row / rows),
                               [&](double x) { return double(value(phase, float(x))); }) *
                2 * pi / columns;
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
        EXPECT_LT(chi2, limit) << int(c.kind) << " " << c.g;
    }
}

}  // namespace
}  // namespace gischt
