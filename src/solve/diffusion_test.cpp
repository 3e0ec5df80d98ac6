// SPDX-License-Identifier: Apache-2.0
#include "solve/diffusion.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/units.h"
#include "solve/test_problem.h"

namespace gischt {
namespace {

using namespace test;

const SolveLimits tight{1e-7, 60};

// An eigenvector of the discrete second difference on `count` points for one rule on both sides:
// value at point i, and the eigenvalue 4 sin^2(k/2).
struct Mode {
    double k, phase;
    double operator()(int i) const { return std::cos(k * i + phase); }
    double eigenvalue() const { return 4 * std::sin(k / 2) * std::sin(k / 2); }
};
Mode mode(Border rule, int count, int order) {
    switch (rule) {
        case Border::Periodic:
            return {2 * pi * order / count, 0.4};
        case Border::Odd: {
            const double k = pi * order / count;
            return {k, 0.5 * k - pi / 2};
        }
        case Border::Zero: {
            const double k = pi * order / (count + 1);
            return {k, k - pi / 2};
        }
        default: {
            const double k = pi * order / count;
            return {k, 0.5 * k};
        }
    }
}

TEST(Diffusion, AScalarModeDecaysByTheFactorOfBackwardEuler) {
    for (const Vec3i n : {Vec3i(36, 30, 1), Vec3i(20, 19, 16)}) {
        for (const Border rule :
             {Border::Even, Border::Clamp, Border::Odd, Border::Zero, Border::Periodic}) {
            for (const double number : {0.01, 1.0, 100.0}) {
                const auto map = TileMap::box(n);
                const Mode along_x = mode(rule, n.x, 2), along_y = mode(rule, n.y, 1);
                const Mode along_z = mode(rule, n.z, 1);
                const auto value = [&](const Vec3i& c) {
                    return along_x(c.x) * along_y(c.y) * (n.z > 1 ? along_z(c.z) : 1.0);
                };
                TileField<float> x(map);
                for_cells(n, [&](const Vec3i& c) { x.ref(c) = static_cast<float>(value(c)); });
                Job job;
                const SolveResult r =
                    diffuse(x, number, {Borders::all(rule), {}}, nullptr, tight, job);
                EXPECT_TRUE(r.converged);
                const double eigenvalue = along_x.eigenvalue() + along_y.eigenvalue() +
                                          (n.z > 1 ? along_z.eigenvalue() : 0.0);
                for_cells(n, [&](const Vec3i& c) {
                    ASSERT_NEAR(x.get(c), value(c) / (1 + number * eigenvalue), 3e-6)
                        << static_cast<int>(rule) << ' ' << number;
                });
            }
        }
    }
}

TEST(Diffusion, HeldSidesKeepALinearScalar) {
    const Vec3i n(24, 40, 9);
    const auto map = TileMap::box(n);
    ScalarSides sides{Borders::all(Border::Even), {}};
    sides.rule.side[2] = Border::Odd;   // 2 on the side itself
    sides.rule.side[3] = Border::Zero;  // 6 one cell beyond
    sides.value = {0, 0, 2, 6, 0, 0};
    const auto exact = [&](const Vec3i& c) { return 2 + 4 * (c.y + 0.5) / (n.y + 0.5); };
    TileField<float> x(map);
    for_cells(n, [&](const Vec3i& c) { x.ref(c) = static_cast<float>(exact(c)); });
    Job job;
    EXPECT_TRUE(diffuse(x, 50, sides, nullptr, tight, job).converged);
    for_cells(n, [&](const Vec3i& c) { ASSERT_NEAR(x.get(c), exact(c), 2e-5); });
    // From anywhere else a large step leads there.
    for_cells(n, [&](const Vec3i& c) { x.ref(c) = 3; });
    EXPECT_TRUE(diffuse(x, 1e6, sides, nullptr, tight, job).converged);
    for_cells(n, [&](const Vec3i& c) { ASSERT_NEAR(x.get(c), exact(c), 5e-3); });
}

TEST(Diffusion, AroundSolidsAScalarIsConservedAndStaysInItsRange) {
    const Vec3i n(40, 37, 24);
    const auto map = TileMap::box(n);
    const FaceField fraction = fractions(map, [&](const Vec3d& p) {
        return sphere_distance(p, {20, 18, 12}, 9.3);
    });
    TileField<float> x(map);
    for_cells(n, [&](const Vec3i& c) { x.ref(c) = c.x < 12 ? 1.0f : 0.0f; });
    x.ref({20, 18, 12}) = 7;  // deep inside the solid
    const auto total = [&] {
        double sum = 0;
        for (const float v : x.values()) sum += static_cast<double>(v);
        return sum;
    };
    const double before = total();
    Job job;
    EXPECT_TRUE(diffuse(x, 30, {Borders::all(Border::Even), {}}, &fraction, tight, job).converged);
    EXPECT_NEAR(total() / before, 1, 1e-6);
    EXPECT_NEAR(x.get({20, 18, 12}), 7, 1e-6);
    x.ref({20, 18, 12}) = 0;
    for_cells(n, [&](const Vec3i& c) {
        ASSERT_GT(x.get(c), -1e-6);
        ASSERT_LT(x.get(c), 1);
    });
}

// Velocity box of n cells with all faces, the last ones too, set by value(axis, face).
template <class F>
FaceField faces(const Vec3i& n, F&& value) {
    FaceField u(TileMap::box(n));
    for (int a = 0; a < u.axes(); ++a) {
        Vec3i count = n;
        count[a] += 1;
        for_cells(count, [&](const Vec3i& f) { u.ref(a, f) = static_cast<float>(value(a, f)); });
    }
    return u;
}

template <class F>
void for_faces(const FaceField& u, F&& f) {
    for (int a = 0; a < u.axes(); ++a) {
        Vec3i count = u.map().bounds().size();
        count[a] += 1;
        for_cells(count, [&](const Vec3i& face) { f(a, face); });
    }
}

TEST(Diffusion, VelocityModesDecayByTheFactorOfBackwardEuler) {
    for (const Vec3i n : {Vec3i(32, 30, 1), Vec3i(17, 16, 20), Vec3i(16, 12, 2)}) {
        for (const Border rule : {Border::Odd, Border::Even, Border::Clamp, Border::Periodic}) {
            // Along its own axis a component has faces on the walls, where it stays zero.
            const auto along = [&](int component, int axis) {
                const bool own = component == axis,
                           wall = rule == Border::Odd || rule == Border::Even;
                if (own && wall) return Mode{pi / n[axis], -pi / 2};
                if (own && rule == Border::Clamp) return mode(Border::Clamp, n[axis] + 1, 1);
                return mode(rule, n[axis], 1);
            };
            const auto exact = [&](int a, const Vec3i& f, double& eigenvalue) {
                double u = 1;
                for (int b = 0; b < (n.z == 1 ? 2 : 3); ++b) {
                    u *= along(a, b)(f[b]);
                    eigenvalue += along(a, b).eigenvalue();
                }
                return u;
            };
            double unused = 0;
            FaceField u = faces(n, [&](int a, const Vec3i& f) { return exact(a, f, unused); });
            Job job;
            const double number = 7;
            const SolveResult r = diffuse(u, number, {Borders::all(rule), {}}, nullptr,
                                          SolidSlip::NoSlip, tight, job);
            EXPECT_TRUE(r.converged);
            for_faces(u, [&](int a, const Vec3i& f) {
                double eigenvalue = 0;
                const double before = exact(a, f, eigenvalue);
                ASSERT_NEAR(u.get(a, f), before / (1 + number * eigenvalue), 3e-6)
                    << static_cast<int>(rule) << ' ' << a;
            });
        }
    }
}

TEST(Diffusion, CouetteFlowBetweenMovingWallsIsLinear) {
    const Vec3i n(16, 40, 10);
    VelocitySides sides{Borders::all(Border::Periodic), {}};
    sides.rule.side[2] = sides.rule.side[3] = Border::Odd;
    sides.velocity[3] = {2, 0, -1};
    FaceField u = faces(n, [](int, const Vec3i&) { return 0.0; });
    Job job;
    EXPECT_TRUE(diffuse(u, 1e6, sides, nullptr, SolidSlip::NoSlip, tight, job).converged);
    for_faces(u, [&](int a, const Vec3i& f) {
        const double speed = static_cast<double>(sides.velocity[3][a]);
        const double exact = a == 1 ? 0 : speed * (f.y + 0.5) / n.y;
        ASSERT_NEAR(u.get(a, f), exact, 1e-3);
    });
}

TEST(Diffusion, NoSlipSolidsDragTheFluidAndFreeSlipOnesDoNot) {
    // A channel between two plates inside the box; the upper one moves.
    const Vec3i n(24, 32, 12);
    FaceField fraction =
        faces(n, [](int, const Vec3i& f) { return f.y < 5 || f.y > 24 ? 0.0 : 1.0; });
    const auto start = [](int a, const Vec3i& f) { return a == 0 && f.y > 24 ? 3.0 : 0.0; };
    FaceField u = faces(n, start);
    const VelocitySides sides{Borders::all(Border::Periodic), {}};
    Job job;
    EXPECT_TRUE(diffuse(u, 1e6, sides, &fraction, SolidSlip::NoSlip, tight, job).converged);
    for_faces(u, [&](int a, const Vec3i& f) {
        // Linear between the last closed faces, at y = 4 and 25.
        const double exact = a == 0 ? 3 * std::clamp((f.y - 4) / 21.0, 0.0, 1.0) : 0;
        ASSERT_NEAR(u.get(a, f), exact, 1e-3);
    });
    u = faces(n, [&](int a, const Vec3i& f) { return f.y >= 5 && f.y <= 24 ? 1.5 : start(a, f); });
    EXPECT_TRUE(diffuse(u, 100, sides, &fraction, SolidSlip::FreeSlip, tight, job).converged);
    for_faces(u, [&](int a, const Vec3i& f) {
        ASSERT_NEAR(u.get(a, f), f.y >= 5 && f.y <= 24 ? 1.5 : start(a, f), 1e-5);
    });
}

TEST(Diffusion, CostsFewIterationsForEveryNumber) {
    const Vec3i n(64, 64, 64);
    const auto map = TileMap::box(n);
    for (const double number : {1e-4, 0.1, 0.25, 1.0, 10.0, 100.0, 1e5}) {
        TileField<float> x(map);
        for_cells(n, [&](const Vec3i& c) {
            x.ref(c) = c.x > 20 && c.x < 40 && c.y > 30 && (c.z & 3) != 0 ? 1.0f : 0.0f;
        });
        Job job;
        const SolveResult r =
            diffuse(x, number, {Borders::all(Border::Even), {}}, nullptr, {1e-5, 50}, job);
        EXPECT_TRUE(r.converged);
        // The right-hand side is small against what the Laplacian makes of x: more digits.
        EXPECT_LE(r.iterations, number > 10 ? 15 : 8) << number;
    }
}

TEST(Diffusion, HasTheSameBitsOnOneAndTwoThreads) {
    const Vec3i n(48, 40, 44);
    FaceField u[2];
    for (int threads = 1; threads <= 2; ++threads) {
        const ThreadLimit limit(threads);
        u[threads - 1] =
            faces(n, [](int a, const Vec3i& f) { return std::sin(0.3 * f.x * f.y + a + f.z); });
        Job job;
        diffuse(u[threads - 1], 3, {Borders::all(Border::Odd), {}}, nullptr, SolidSlip::NoSlip,
                {1e-5, 50}, job);
    }
    for (int a = 0; a < 3; ++a) EXPECT_TRUE(u[0][a].values() == u[1][a].values());
}

TEST(Diffusion, RefusesNegativeNumbersAndKeepsAllForZero) {
    TileField<float> x(TileMap::box({20, 20, 1}), 1.25f);
    const TileField<float> before = x;
    Job job;
    const ScalarSides sides{Borders::all(Border::Odd), {}};
    EXPECT_THROW(diffuse(x, -1, sides, nullptr, {}, job), Error);
    EXPECT_THROW(diffuse(x, std::nan(""), sides, nullptr, {}, job), Error);
    EXPECT_TRUE(diffuse(x, 0, sides, nullptr, {}, job).converged);
    EXPECT_TRUE(x.values() == before.values());
}

}  // namespace
}  // namespace gischt
