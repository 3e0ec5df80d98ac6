// SPDX-License-Identifier: Apache-2.0
#include "solve/poisson.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/units.h"
#include "solve/test_problem.h"

namespace gischt {
namespace {

using namespace test;

// One factor of a product solution of -lap u = f on [0, 1] that satisfies the sides: u = f(x) and
// -u'' = k^2 u. Open sides are zero half a cell beyond the side, which the argument allows for.
double mode(Side low, Side high, double x, double h, double& k2) {
    const double reach = (low == Side::Open ? 0.5 * h : 0) + (high == Side::Open ? 0.5 * h : 0);
    const double s = (x + (low == Side::Open ? 0.5 * h : 0)) / (1 + reach);
    double k = 0, value = 0;
    if (low == Side::Periodic) {
        k = 2 * pi, value = std::sin(k * s + 0.3);
    } else if (low == Side::Wall && high == Side::Wall) {
        k = pi, value = std::cos(k * s);
    } else if (low == Side::Open && high == Side::Open) {
        k = pi, value = std::sin(k * s);
    } else if (low == Side::Wall) {
        k = pi / 2, value = std::cos(k * s);
    } else {
        k = pi / 2, value = std::sin(k * s);
    }
    k2 += k * k / ((1 + reach) * (1 + reach));
    return value;
}

// Largest error against the analytic solution on a box of n cells of edge 1/n.
double analytic_error(const Vec3i& n, const Sides& sides) {
    const auto map = TileMap::box(n);
    TileField<float> b(map), x(map);
    const auto exact = [&](const Vec3i& c, double& k2) {
        double u = 1;
        for (int a = 0; a < (map->is_2d() ? 2 : 3); ++a) {
            const auto s = static_cast<std::size_t>(2 * a);
            u *= mode(sides[s], sides[s + 1], (c[a] + 0.5) / n.x, 1.0 / n.x, k2);
        }
        return u;
    };
    for_cells(n, [&](const Vec3i& c) {
        double k2 = 0;
        const double u = exact(c, k2);
        b.ref(c) = static_cast<float>(k2 * u / (n.x * n.x));
    });
    PoissonSolver solver(map, sides);
    Job job;
    const SolveResult r = solver.solve(b, x, 1e-7, 50, job);
    EXPECT_TRUE(r.converged);
    double error = 0;
    for_cells(n, [&](const Vec3i& c) {
        double k2 = 0;
        error = std::max(error, std::abs(exact(c, k2) - static_cast<double>(x.get(c))));
    });
    return error;
}

TEST(Poisson, ConvergesWithSecondOrderOnAllSides) {
    const Side w = Side::Wall, o = Side::Open, p = Side::Periodic;
    for (const Sides& sides : {closed_box, open_top, all_open, all_periodic,
                               Sides{p, p, w, o, o, w}, Sides{o, w, p, p, p, p}}) {
        for (const int z : {0, 1}) {
            const auto size = [&](int n) { return Vec3i(n, n, z == 0 ? 1 : n); };
            const double coarse = analytic_error(size(20), sides);
            const double fine = analytic_error(size(40), sides);
            EXPECT_LT(fine, 0.01);
            EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1) << z;
        }
    }
}

// A solid in a box, by name, so that a failure says which.
struct Case {
    const char* name;
    Vec3i n;
    Sides sides;
    bool sphere, board;
    int most;  // iterations to 1e-6
};

class Iterations : public testing::TestWithParam<Case> {};

TEST_P(Iterations, AreFewAtEverySize) {
    const Case& c = GetParam();
    const auto map = TileMap::box(c.n);
    FaceField fraction;
    if (c.sphere || c.board) {
        fraction = fractions(map, [&](const Vec3d& p) {
            const double far = 1e9, radius = 0.15 * min_component(Vec3d(c.n.x, c.n.y, c.n.x));
            Vec3d center = 0.35 * Vec3d(c.n);
            if (map->is_2d()) center.z = p.z;
            return std::min(c.sphere ? sphere_distance(p, center, radius) : far,
                            c.board ? board_distance(p, c.n) : far);
        });
    }
    const FaceField* given = c.sphere || c.board ? &fraction : nullptr;
    PoissonSolver solver(map, c.sides, given);
    const TileField<float> b = plume(map, c.sides, given);
    TileField<float> x(map);
    Job job;
    const SolveResult r = solver.solve(b, x, 1e-6, 50, job);
    EXPECT_TRUE(r.converged);
    EXPECT_LE(r.iterations, c.most);
    RecordProperty("iterations", r.iterations);
    // The rounding of x to float leaves a true residual of a few times 1e-7 max|x| / max|b|.
    float x_max = 0, b_max = 0;
    for (const float v : x.values()) x_max = std::max(x_max, std::abs(v));
    for (const float v : b.values()) b_max = std::max(b_max, std::abs(v));
    EXPECT_LT(residual(b, x, c.sides, given), 1.5e-6 + 2e-6 * static_cast<double>(x_max / b_max));
}

INSTANTIATE_TEST_SUITE_P(
    Boxes, Iterations,
    testing::Values(Case{"closed64", Vec3i(64), closed_box, false, false, 10},
                    Case{"closed128", Vec3i(128), closed_box, false, false, 10},
                    Case{"open64", Vec3i(64), open_top, false, false, 10},
                    Case{"open128", Vec3i(128), open_top, false, false, 10},
                    Case{"all_open64", Vec3i(64), all_open, false, false, 10},
                    Case{"periodic64", Vec3i(64), all_periodic, false, false, 10},
                    Case{"periodic128", Vec3i(128), all_periodic, false, false, 10},
                    Case{"sphere64", Vec3i(64), open_top, true, false, 12},
                    Case{"sphere128", Vec3i(128), closed_box, true, false, 12},
                    Case{"board64", Vec3i(64), closed_box, false, true, 12},
                    Case{"both64", Vec3i(64), open_top, true, true, 12},
                    Case{"both128", Vec3i(128), open_top, true, true, 12},
                    Case{"tall", Vec3i(80, 80, 128), open_top, false, false, 10},
                    Case{"tall_periodic", Vec3i(80, 80, 128), all_periodic, true, false, 12},
                    Case{"odd", Vec3i(67, 45, 91), open_top, true, false, 12},
                    Case{"odd_periodic", Vec3i(67, 45, 51), all_periodic, false, false, 12},
                    Case{"slab", Vec3i(64, 64, 3), open_top, true, false, 12},
                    Case{"column", Vec3i(9, 200, 9), open_top, false, false, 12},
                    Case{"flat", Vec3i(512, 512, 1), open_top, false, false, 10},
                    Case{"flat_both", Vec3i(512, 512, 1), closed_box, true, true, 12},
                    Case{"flat_odd", Vec3i(301, 117, 1), all_periodic, true, false, 12}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(Poisson, SolvesPocketsEachWithZeroMean) {
    // A hollow ball: its inside knows nothing of the outside. Another solid fills a corner.
    const Vec3i n(40, 33, 36);
    const auto map = TileMap::box(n);
    const FaceField fraction = fractions(map, [&](const Vec3d& p) {
        const double shell = std::abs(sphere_distance(p, {20, 16, 18}, 10)) - 1.5;
        return std::min(shell, sphere_distance(p, {0, 0, 0}, 8));
    });
    for (const Sides& sides : {closed_box, open_top}) {
        TileField<float> b = plume(map, sides, &fraction);
        TileField<float> x(map, 3.0f);
        // What cannot be solved, a source in the pocket, is taken out of it.
        TileField<float> source = b;
        for_cells(n, [&](const Vec3i& c) {
            if (sphere_distance(Vec3d(c) + Vec3d(0.5), {20, 16, 18}, 8) < 0) source.ref(c) += 0.5f;
        });
        PoissonSolver solver(map, sides, &fraction);
        Job job;
        EXPECT_TRUE(solver.solve(source, x, 1e-6, 60, job).converged);
        TileField<float> y(map);
        const SolveResult r = solver.solve(b, y, 1e-6, 60, job);
        EXPECT_TRUE(r.converged);
        EXPECT_LE(r.iterations, 25);
        EXPECT_LT(residual(b, y, sides, &fraction), 1e-5);
        double inside = 0, outside = 0, difference = 0;
        for_cells(n, [&](const Vec3i& c) {
            const bool in = sphere_distance(Vec3d(c) + Vec3d(0.5), {20, 16, 18}, 10) < 0;
            (in ? inside : outside) += static_cast<double>(y.get(c));
            if (!in) return;
            difference = std::max(difference, static_cast<double>(std::abs(x.get(c) - y.get(c))));
        });
        EXPECT_NEAR(inside, 0, 0.1);
        if (sides == closed_box) {
            EXPECT_NEAR(outside, 0, 0.1);
        }
        EXPECT_EQ(y.get({1, 1, 1}), 0);
        // Only a part of the pocket has the source, so that the rest differs, but by finite values.
        EXPECT_LT(difference, 100);
    }
}

TEST(Poisson, AClosedBoxTakesOutTheMeanAndAClosedCellStaysZero) {
    const auto map = TileMap::box({24, 24, 24});
    FaceField fraction(map, 1);
    for (int a = 0; a < 3; ++a) {
        Vec3i up(5, 6, 7);
        up[a] += 1;
        fraction.ref(a, {5, 6, 7}) = fraction.ref(a, up) = 0;
    }
    TileField<float> b(map), x(map, 1.0f);
    for_cells({24, 24, 24}, [&](const Vec3i& c) { b.ref(c) = 1; });
    b.ref({20, 3, 4}) = 5;
    PoissonSolver solver(map, closed_box, &fraction);
    Job job;
    EXPECT_TRUE(solver.solve(b, x, 1e-6, 30, job).converged);
    EXPECT_EQ(x.get({5, 6, 7}), 0);
    double mean = 0, largest = 0;
    for (const float v : x.values()) {
        mean += static_cast<double>(v) / (24 * 24 * 24);
        largest = std::max(largest, static_cast<double>(std::abs(v)));
    }
    EXPECT_NEAR(mean, 0, 1e-7 * largest);
    // The solution is the one of the source less its mean.
    EXPECT_NEAR(apply(x, closed_box, &fraction, {20, 3, 4}), 4 * (1 - 1.0 / 13823), 1e-4);
}

TEST(Poisson, ZeroGivesZeroAndASolutionIsKept) {
    const auto map = TileMap::box({30, 20, 1});
    TileField<float> zero(map), x(map, 2.0f);
    PoissonSolver solver(map, open_top);
    Job job;
    SolveResult r = solver.solve(zero, x, 1e-6, 30, job);
    EXPECT_TRUE(r.converged);
    EXPECT_EQ(r.iterations, 0);
    for (const float v : x.values()) EXPECT_EQ(v, 0);

    const TileField<float> b = plume(map, open_top, nullptr);
    r = solver.solve(b, x, 1e-5, 30, job);
    EXPECT_GT(r.iterations, 3);
    r = solver.solve(b, x, 1e-5, 30, job);
    EXPECT_LE(r.iterations, 1);
    // Half of the way leaves at most the whole way.
    for (float& v : x.values()) v *= 0.5f;
    const SolveResult half = solver.solve(b, x, 1e-5, 30, job);
    EXPECT_TRUE(half.converged);
}

TEST(Poisson, HasTheSameBitsOnOneAndTwoThreads) {
    for (const Vec3i n : {Vec3i(72, 64, 57), Vec3i(300, 200, 1)}) {
        const auto map = TileMap::box(n);
        const FaceField fraction = fractions(
            map, [&](const Vec3d& p) { return sphere_distance(p, 0.4 * Vec3d(n), 0.2 * n.y); });
        const TileField<float> b = plume(map, closed_box, &fraction);
        TileField<float> x[2] = {TileField<float>(map), TileField<float>(map)};
        for (int threads = 1; threads <= 2; ++threads) {
            const ThreadLimit limit(threads);
            Job job;
            PoissonSolver solver(map, closed_box, &fraction);
            solver.solve(b, x[threads - 1], 1e-5, 30, job);
        }
        EXPECT_TRUE(x[0].values() == x[1].values());
    }
}

TEST(Poisson, RefusesHalfPeriodicAxesAndStopsWhenAsked) {
    const auto map = TileMap::box({40, 40, 40});
    Sides sides = closed_box;
    sides[1] = Side::Periodic;
    EXPECT_THROW(PoissonSolver(map, sides), Error);
    PoissonSolver solver(map, closed_box);
    TileField<float> x(map);
    Job job;
    job.cancel();
    EXPECT_THROW(solver.solve(plume(map, closed_box, nullptr), x, 1e-6, 30, job), Error);
}

}  // namespace
}  // namespace gischt
