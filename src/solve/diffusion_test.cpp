// SPDX-License-Identifier: Apache-2.0
#include "solve/diffusion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

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
            const SolveResult r = diffuse(u, number, {Borders::all(rule), {}}, {}, tight, job);
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
    EXPECT_TRUE(diffuse(u, 1e6, sides, {}, tight, job).converged);
    for_faces(u, [&](int a, const Vec3i& f) {
        const double speed = static_cast<double>(sides.velocity[3][a]);
        const double exact = a == 1 ? 0 : speed * (f.y + 0.5) / n.y;
        ASSERT_NEAR(u.get(a, f), exact, 1e-3);
    });
}

TEST(Diffusion, FreeSlipSolidsDoNotDragTheFluid) {
    // A channel between two plates inside the box.
    const Vec3i n(24, 32, 12);
    const FaceField fraction =
        faces(n, [](int, const Vec3i& f) { return f.y < 5 || f.y > 24 ? 0.0 : 1.0; });
    const auto start = [](int a, const Vec3i& f) {
        return f.y >= 5 && f.y <= 24 ? 1.5 : a == 0 && f.y > 24 ? 3.0 : 0.0;
    };
    FaceField u = faces(n, start);
    const VelocitySides sides{Borders::all(Border::Periodic), {}};
    Job job;
    EXPECT_TRUE(diffuse(u, 100, sides, {&fraction, nullptr, nullptr}, tight, job).converged);
    for_faces(u, [&](int a, const Vec3i& f) { ASSERT_NEAR(u.get(a, f), start(a, f), 1e-5); });
}

// Place of a face of a box in metres, its lower corner being the origin.
Vec3d place(int axis, const Vec3i& face, double h) {
    Vec3d p = h * (Vec3d(face) + Vec3d(0.5));
    p[axis] -= 0.5 * h;
    return p;
}

TEST(Diffusion, CouetteFlowBetweenPlatesAtAnyOffsetIsLinear) {
    // Linear profiles are exact, wherever the plates cut the cells; the upper one moves.
    const Vec3i n(16, 32, 8);
    for (const double offset : {0.02, 0.13, 0.37, 0.5, 0.81, 0.99}) {
        const double low = 4 + offset, high = 25.3 - offset;
        const FaceField distance = faces(n, [&](int a, const Vec3i& f) {
            const double y = place(a, f, 1).y;
            return std::min(y - low, high - y);
        });
        const FaceField wall = faces(
            n, [&](int a, const Vec3i& f) { return a == 0 && place(a, f, 1).y > 15 ? 3.0 : 0.0; });
        FaceField u = faces(n, [&](int a, const Vec3i& f) {
            return distance.get(a, f) > 0 ? 0.5 : wall.get(a, f);
        });
        const VelocitySides sides{Borders::all(Border::Periodic), {}};
        Job job;
        EXPECT_TRUE(diffuse(u, 1e6, sides, {nullptr, &distance, &wall}, tight, job).converged);
        for_faces(u, [&](int a, const Vec3i& f) {
            const double share = (place(a, f, 1).y - low) / (high - low);
            const double exact = a == 0 ? 3 * std::clamp(share, 0.0, 1.0) : 0;
            ASSERT_NEAR(u.get(a, f), exact, 2e-3) << offset;
        });
    }
}

// A velocity field in the plane of a circle or ring around `center`; `distance` in metres.
struct Ring {
    Vec3d center{0.5037, 0.4961, 0};
    double inner = 0, outer = 0;

    double distance(const Vec3d& p) const {
        const double r = radius(p);
        return inner > 0 ? std::min(r - inner, outer - r) : outer - r;
    }
    double radius(const Vec3d& p) const { return std::hypot(p.x - center.x, p.y - center.y); }
    // Component of the tangential unit vector.
    double along(int axis, const Vec3d& p) const {
        const double r = std::max(radius(p), 1e-12);
        return axis == 0 ? -(p.y - center.y) / r : (p.x - center.x) / r;
    }
};

// Root mean square error of a velocity in the fluid after one step of diffusion from `start` with
// speeds(radius), in one direction of turning.
template <class Start, class Wall, class Exact>
double ring_error(const Ring& ring, int n, double diffusion, Start&& start, Wall&& wall,
                  Exact&& exact) {
    const double h = 1.0 / n;
    const auto turning = [&](auto&& speed) {
        return faces({n, n, 1}, [&](int a, const Vec3i& f) {
            const Vec3d p = place(a, f, h);
            return ring.along(a, p) * speed(ring.radius(p));
        });
    };
    const FaceField distance =
        faces({n, n, 1}, [&](int a, const Vec3i& f) { return ring.distance(place(a, f, h)); });
    const FaceField held = turning(wall);
    FaceField u = turning(start);
    for_faces(u, [&](int a, const Vec3i& f) {
        if (!(distance.get(a, f) > 0)) u.ref(a, f) = held.get(a, f);
    });
    Job job;
    const VelocitySides sides{Borders::all(Border::Clamp), {}};
    EXPECT_TRUE(
        diffuse(u, diffusion / (h * h), sides, {nullptr, &distance, &held}, {1e-7, 200}, job)
            .converged);
    double sum = 0;
    int count = 0;
    for_faces(u, [&](int a, const Vec3i& f) {
        if (!(distance.get(a, f) > 0)) return;
        const Vec3d p = place(a, f, h);
        const double e =
            static_cast<double>(u.get(a, f)) - ring.along(a, p) * exact(ring.radius(p));
        sum += e * e;
        ++count;
    });
    return std::sqrt(sum / count);
}

void expect_second_order(const std::array<double, 3>& e) {
    const double order = std::log2(e[0] / e[2]) / 2;
    testing::Test::RecordProperty("order", std::to_string(order));
    EXPECT_GT(order, 1.8) << e[0] << ' ' << e[1] << ' ' << e[2];
}

TEST(Diffusion, FlowBetweenTurningCylindersIsOfSecondOrder) {
    // u = A r + B / r (Couette 1890).
    Ring ring;
    ring.inner = 0.153;
    ring.outer = 0.417;
    const double turn_in = 2, turn_out = -0.5;  // rad/s
    const double i2 = ring.inner * ring.inner, o2 = ring.outer * ring.outer;
    const double a = (turn_out * o2 - turn_in * i2) / (o2 - i2),
                 b = (turn_in - turn_out) * i2 * o2 / (o2 - i2);
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < 3; ++i) {
        errors[i] = ring_error(
            ring, 32 << i, 1e2, [](double) { return 0.0; },
            [&](double r) { return (r < 0.28 ? turn_in : turn_out) * r; },
            [&](double r) { return a * r + b / r; });
    }
    expect_second_order(errors);
}

TEST(Diffusion, AVortexInACylinderDecaysAsBesselFunctionsDo) {
    // u = J1(k r) with J1(k R) = 0 is an eigenfunction: a step of backward Euler divides it by
    // 1 + nu dt k^2.
    Ring ring;
    ring.outer = 0.437;
    const double k = 3.8317059702075123 / ring.outer, nu_dt = 2 / (k * k);
    const auto bessel = [&](double r) { return std::cyl_bessel_j(1.0, k * r); };
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < 3; ++i) {
        errors[i] = ring_error(
            ring, 32 << i, nu_dt, bessel, [](double) { return 0.0; },
            [&](double r) { return bessel(r) / 3; });
    }
    expect_second_order(errors);
}

TEST(Diffusion, HeatBetweenCylindersIsLogarithmicToSecondOrder) {
    Ring ring;
    ring.inner = 0.153;
    ring.outer = 0.417;
    const auto exact = [&](double r) {
        return 5 + 20 * std::log(r / ring.inner) / std::log(ring.outer / ring.inner);
    };
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < 3; ++i) {
        const int n = 32 << i;
        const double h = 1.0 / n;
        TileField<float> x(TileMap::box({n, n, 1})), distance = x, value = x;
        const auto at = [&](const Vec3i& c) { return h * (Vec3d(c) + Vec3d(0.5)); };
        for_cells({n, n, 1}, [&](const Vec3i& c) {
            distance.ref(c) = static_cast<float>(ring.distance(at(c)));
            value.ref(c) = ring.radius(at(c)) < 0.28 ? 5.0f : 25.0f;
            x.ref(c) = distance.get(c) > 0 ? 10.0f : value.get(c);
        });
        Job job;
        const ScalarSolids solids{nullptr, &distance, &value};
        EXPECT_TRUE(
            diffuse(x, 1e4 / (h * h), {Borders::all(Border::Even), {}}, solids, {1e-7, 200}, job)
                .converged);
        int count = 0;
        for_cells({n, n, 1}, [&](const Vec3i& c) {
            if (!(distance.get(c) > 0)) return;
            const double e = static_cast<double>(x.get(c)) - exact(ring.radius(at(c)));
            errors[i] += e * e;
            ++count;
        });
        errors[i] = std::sqrt(errors[i] / count);
    }
    expect_second_order(errors);
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
        diffuse(u[threads - 1], 3, {Borders::all(Border::Odd), {}}, {}, {1e-5, 50}, job);
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
