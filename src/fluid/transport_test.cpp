// SPDX-License-Identifier: Apache-2.0
#include "fluid/transport.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/units.h"
#include "fluid/smoke.h"

namespace gischt {
namespace {

// A scalar in a steady flow given by its stream function, so that the faces have no divergence.
class Carried {
  public:
    Carried(int resolution, SideKind sides, const std::function<double(double, double)>& stream)
        : domain(params(resolution, sides)),
          blocks(domain.map),
          now(blocks, domain.map),
          velocity_(domain.map),
          predicted_(now),
          next_(now) {
        for (int a = 0; a < 2; ++a) {
            for_cells(domain.faces_of({{}, domain.cells}, a), [&](const Vec3i& f) {
                const double x = f.x * domain.h, y = f.y * domain.h, h = domain.h;
                velocity_.ref(a, f) =
                    static_cast<float>(a == 0 ? (stream(x, y + h) - stream(x, y)) / h
                                              : -(stream(x + h, y) - stream(x, y)) / h);
            });
        }
        speeds_ = measure_speeds(domain, blocks, velocity_);
    }

    void fill(const std::function<double(const Vec3d&)>& value) {
        for_cells({{}, domain.cells}, [&](const Vec3i& c) {
            now.values.ref(c) = static_cast<float>(value(domain.center_of(c)));
        });
        drop_small(blocks, now, 0);
    }
    void step(double dt) {
        AdvectedScalar q{&now, &predicted_, &next_, AdvectionScheme::Conservative};
        Job job;
        transport(domain, blocks, velocity_, speeds_, nullptr, dt, q, job);
    }
    double sum() const {
        double total = 0;
        for_cells({{}, domain.cells}, [&](const Vec3i& c) { total += now.values.get(c); });
        return total * domain.h * domain.h;
    }
    double error(const std::function<double(const Vec3d&)>& expected) const {
        double total = 0;
        for_cells({{}, domain.cells}, [&](const Vec3i& c) {
            const double d = now.values.get(c) - expected(domain.center_of(c));
            total += d * d;
        });
        return std::sqrt(total) * domain.h;
    }
    static DomainParams params(int resolution, SideKind sides) {
        DomainParams p;
        p.resolution = resolution;
        p.max = {1, 1, 0};
        p.set_all_sides(sides);
        return p;
    }

    Domain domain;
    BlockMap blocks;
    SparseField now;

  private:
    FaceField velocity_;
    BlockSpeeds speeds_;
    SparseField predicted_, next_;
};

double turning(double x, double y) {
    return -pi * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5));
}

TEST(Transport, TurnsABlobWithTheOrderOfItsSlopes) {
    const auto blob = [](const Vec3d& p) {
        return std::exp(-(std::pow(p.x - 0.5, 2) + std::pow(p.y - 0.7, 2)) / (2 * 0.05 * 0.05));
    };
    std::vector<double> errors;
    for (const int n : {48, 96}) {
        Carried flow(n, SideKind::FreeSlip, turning);
        flow.fill(blob);
        const double before = flow.sum();
        for (int s = 0; s < 4 * n; ++s) flow.step(1.0 / (4 * n));
        errors.push_back(flow.error(blob));
        EXPECT_NEAR(flow.sum() / before, 1, 1e-5);
    }
    const double order = std::log2(errors[0] / errors[1]);
    fmt::print("  errors {:.5f} {:.5f}, order {:.2f}\n", errors[0], errors[1], order);
    EXPECT_GT(order, 1.8);
}

// A block of smoke with sharp edges in swirling air keeps its amount and the range of its values.
TEST(Transport, KeepsAmountAndBounds) {
    Carried flow(64, SideKind::FreeSlip, [](double x, double y) {
        return 0.3 * std::pow(std::sin(pi * x) * std::sin(pi * y), 2);
    });
    flow.fill([](const Vec3d& p) { return std::abs(p.x - 0.4) < 0.15 && p.y > 0.5 ? 1.0 : 0.0; });
    const double before = flow.sum();
    for (int s = 0; s < 60; ++s) flow.step(0.05);
    EXPECT_NEAR(flow.sum() / before, 1, 1e-5);
    for (const float v : flow.now.values.values()) {
        ASSERT_GE(v, -1e-6f);
        ASSERT_LE(v, 1 + 1e-5f);
    }
}

TEST(Transport, LeavesAnEvenAmountEven) {
    Carried flow(40, SideKind::Periodic, [](double x, double y) {
        return 0.2 * std::sin(2 * pi * x) * std::cos(4 * pi * y);
    });
    flow.fill([](const Vec3d&) { return 0.7; });
    for (int s = 0; s < 10; ++s) flow.step(0.1);
    for_cells({{}, flow.domain.cells},
              [&](const Vec3i& c) { ASSERT_NEAR(flow.now.values.get(c), 0.7, 2e-6); });
}

// A plume in a closed box for 200 steps: what the sources have given is still there.
double drift_of_mass(AdvectionScheme scheme, Accuracy accuracy) {
    SmokeParams params;
    params.domain.resolution = 24;
    params.domain.max = {1, 1, 1};
    params.domain.set_all_sides(SideKind::FreeSlip);
    params.density_advection = scheme;
    params.accuracy = accuracy;
    FluidWorld world;
    world.solids.emplace_back();
    world.solids[0].position = Vec3d(0.45, 0.5, 0.7);
    world.solids[0].radius = 0.15;
    SmokeSolver solver(params, world);
    Job job;
    const auto hot = [](const Vec3d& p) { return length(p - Vec3d(0.5, 0.5, 0.25)) < 0.15; };
    solver.fill({.velocity = nullptr,
                 .density = [&](const Vec3d& p) { return hot(p) ? 1.0 : 0.0; },
                 .temperature = [&](const Vec3d& p) { return hot(p) ? 340.0 : 293.15; }},
                job);
    const double before = solver.density_integral();
    for (int s = 0; s < 200; ++s) solver.step(std::min(0.04, solver.longest_step()), job);
    const double change = solver.density_integral() / before - 1;
    fmt::print("  mass after 200 steps: {:+.2e}\n", change);
    return change;
}

TEST(Transport, HoldsTheMassOfAPlumeAroundABall) {
    EXPECT_LT(std::abs(drift_of_mass(AdvectionScheme::Conservative, Accuracy::Standard)), 1e-3);
    EXPECT_LT(std::abs(drift_of_mass(AdvectionScheme::Conservative, Accuracy::High)), 1e-3);
    drift_of_mass(AdvectionScheme::MacCormack, Accuracy::Standard);  // printed, for comparison
}

}  // namespace
}  // namespace gischt
