// SPDX-License-Identifier: Apache-2.0
#include "optics/phase_lobes.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "math/quadrature.h"
#include "optics/test_chi_squared.h"

namespace gischt {
namespace {

double hg(double g, const Vec3d& a, const Vec3d& b) {
    const double c = dot(a, b);
    return 0.25 / pi * (1 - g * g) / std::pow(1 + g * g - 2 * g * c, 1.5);
}

struct Pair {
    float g, h;
    double angle;
};
const Pair pairs[] = {{0.5f, 0.5f, 1.0},    {0.877f, 0.35f, 2.5}, {0.877f, 0.877f, 0.7},
                      {0.877f, 0.6f, 1e-4}, {0.0f, 0.8f, 1.2},    {0.8f, 0.0f, 2.0},
                      {-0.6f, 0.7f, 1.1},   {0.3f, 0.3f, 0.0},    {0.2f, -0.5f, 3.1},
                      {0.0f, 0.0f, 0.4},    {0.7f, 0.7f, 3.14},   {0.95f, 0.5f, 0.3}};

// Two turns in succession are distributed like one with the product of their mean cosines.
TEST(PhaseLobes, HenyeyGreensteinIsASemigroup) {
    const GaussLegendre rule(40);
    const Vec3d a(0, 0, 1);
    for (const Pair& p : {pairs[0], pairs[1], pairs[6]}) {
        const Vec3d b(std::sin(p.angle), 0, std::cos(p.angle));
        const double g = static_cast<double>(p.g), h = static_cast<double>(p.h);
        double sum = 0;
        for (int panel = 0; panel < 64; ++panel) {
            const int row = panel / 8, column = panel % 8;
            sum += rule.integrate(-1 + 0.25 * row, -0.75 + 0.25 * row, [&](double c) {
                return rule.integrate(0.25 * pi * column, 0.25 * pi * (column + 1), [&](double t) {
                    const double s = std::sqrt(1 - c * c);
                    const Vec3d w(s * std::cos(t), s * std::sin(t), c);
                    return hg(g, a, w) * hg(h, w, b);
                });
            });
        }
        EXPECT_NEAR(sum / hg(g * h, a, b), 1, 1e-6) << p.g << " " << p.h;
    }
}

TEST(PhaseLobes, DirectionsBetweenTwoAreDrawnByTheirProduct) {
    std::uint64_t seed = 0;
    for (const Pair& p : pairs) {
        const Vec3d a = normalize(Vec3d(1, -2, 0.5));
        Vec3d s, t;
        orthonormal_frame(a, s, t);
        const Vec3d b = std::cos(p.angle) * a + std::sin(p.angle) * t;
        const double g = static_cast<double>(p.g), h = static_cast<double>(p.h);
        const ChiSquared c = chi_squared(
            [&](std::uint64_t key) {
                return std::optional(sample_between(
                    a, p.g, b, p.h,
                    {random_uniform(key, 0), random_uniform(key, 1), random_uniform(key, 2)}));
            },
            [&](const Vec3d& w) { return hg(g, a, w) * hg(h, w, b) / hg(g * h, a, b); }, ++seed);
        // A family of 12 at 1e-3.
        EXPECT_GT(c.p_value, 1e-3 / 12) << fmt::format("g {} h {} angle {}", p.g, p.h, p.angle);
    }
}

// The lobes with their factors are the phase function.
TEST(PhaseLobes, SumUpToThePhaseFunction) {
    const PhaseParams cases[] = {
        {PhaseKind::Isotropic, 0},
        {PhaseKind::HenyeyGreenstein, 0.877},
        {PhaseKind::HenyeyGreenstein, -0.3},
        {PhaseKind::Schlick, 0.7},
        {PhaseKind::Rayleigh, 0},
        {.kind = PhaseKind::TwoLobe, .g = 0.85, .g2 = -0.4, .lobe_weight = 0.7},
        {.kind = PhaseKind::Mie, .droplet_diameter = 0.3},
        {.kind = PhaseKind::Mie, .droplet_diameter = 10},
    };
    for (const PhaseParams& c : cases) {
        const PhaseFunction phase = make_phase(c);
        const PhaseLobes lobes = PhaseLobes::of(phase);
        for (float cosine = -1; cosine <= 1; cosine += 0.125f) {
            float sum = 0;
            for (int i = 0; i < lobes.count; ++i) {
                const auto& lobe = lobes.lobes[static_cast<std::size_t>(i)];
                sum += lobe.weight * kernel_factor(lobe, cosine) *
                       HenyeyGreensteinPhase{lobe.g}.value(cosine);
            }
            EXPECT_NEAR(sum / value(phase, cosine), 1, 1e-4) << int(c.kind) << " " << cosine;
        }
    }
}

TEST(PhaseLobes, ForgetAfterAsManyTurnsAsTheyAreForward) {
    const auto memory = [](double g) {
        return PhaseLobes::of(make_phase(PhaseKind::HenyeyGreenstein, g)).memory;
    };
    EXPECT_EQ(memory(0), 0);
    EXPECT_EQ(memory(0.35), 0);
    EXPECT_EQ(memory(0.5), 1);  // 0.5^2 = 0.25
    EXPECT_EQ(memory(0.8), 4);  // 0.8^5 = 0.328
    EXPECT_EQ(memory(-0.8), 4);
    EXPECT_EQ(memory(0.877), 7);  // 0.877^8 = 0.350
    EXPECT_EQ(memory(0.99), PhaseLobes::longest - 2);
}

}  // namespace
}  // namespace gischt
