// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "fluid/smoke.h"

namespace gischt {
namespace {

// The Taylor-Green vortex, carried along by a uniform wind: u = U + sin(x - U t) cos y e, ...
struct Vortex {
    double error = 0;         // root mean square of u at the end
    double energy_ratio = 0;  // of the vortex
};

Vortex vortex(int resolution, double nu, double time, int steps, double wind) {
    SmokeParams params;
    params.domain.resolution = resolution;
    params.domain.max = {2 * pi, 2 * pi, 0};
    params.domain.set_all_sides(SideKind::Periodic);
    params.viscosity = nu;
    params.accuracy = Accuracy::High;
    params.pressure_tolerance = 1e-6;
    FluidWorld world;
    world.gravity = {};
    SmokeSolver solver(params, world);
    Job job;
    const auto flow = [&](const Vec3d& p, double t) {
        const double x = p.x - wind * t, y = p.y - 0.5 * wind * t, e = std::exp(-2 * nu * t);
        return Vec3d(wind + e * std::sin(x) * std::cos(y),
                     0.5 * wind - e * std::cos(x) * std::sin(y), 0);
    };
    solver.fill({.velocity = [&](const Vec3d& p) { return flow(p, 0); },
                 .density = nullptr,
                 .temperature = nullptr},
                job);
    for (int s = 0; s < steps; ++s) solver.step(time / steps, job);
    Vortex v;
    for_cells({{}, solver.domain().cells}, [&](const Vec3i& c) {
        for (int a = 0; a < 2; ++a) {
            const Vec3d p = solver.domain().face_center(a, c);
            const double u = solver.state().velocity.get(a, c);
            v.error += std::pow(u - flow(p, time)[a], 2) / (2.0 * resolution * resolution);
            v.energy_ratio +=
                std::pow(u - (a == 0 ? wind : 0.5 * wind), 2) / (0.5 * resolution * resolution);
        }
    });
    v.error = std::sqrt(v.error);
    return v;
}

TEST(SecondOrder, InSpace) {
    std::vector<double> errors;
    for (const int n : {16, 32, 64}) {
        const double h = 2 * pi / n;
        const int steps = static_cast<int>(std::lround(0.5 / (h * h / 4)));
        errors.push_back(vortex(n, 0.05, 0.5, steps, 0).error);
    }
    const double order = std::log2(errors[1] / errors[2]);
    fmt::print("  errors {:.2e} {:.2e} {:.2e}, order {:.2f} in h\n", errors[0], errors[1],
               errors[2], order);
    EXPECT_GT(order, 1.8);
}

// The error of one step size against the half and the quarter of it, on a grid too fine to matter.
TEST(SecondOrder, InTime) {
    for (const double wind : {0.0, 1.0}) {
        std::vector<double> errors;
        for (const int steps : {8, 16, 32})
            errors.push_back(vortex(192, 0.05, 2, steps, wind).error);
        const double order = std::log2(errors[0] / errors[1]);
        fmt::print("  wind {}: errors {:.2e} {:.2e} {:.2e}, order {:.2f} in dt\n", wind, errors[0],
                   errors[1], errors[2], order);
        EXPECT_GT(order, 1.7);
    }
}

TEST(SecondOrder, HardlyLosesEnergy) {
    for (const int steps : {5, 10, 20, 80}) {
        const Vortex v = vortex(64, 0, 1, steps, 0);
        const double nu = -std::log(v.energy_ratio) / 4;
        fmt::print("  numerical viscosity at 64^2, CFL {:.2g}: {:+.2e} m^2/s\n",
                   64 / (2 * pi * steps), nu);
        // Advecting first and projecting then costs dt / 8 in this flow.
        EXPECT_LT(std::abs(nu), 0.05 / (8.0 * steps));
    }
}

}  // namespace
}  // namespace gischt
