// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gischt {
namespace {

template <class F>
void for_cells(const Vec3i& n, F&& f) {
    for (int k = 0; k < n.z; ++k) {
        for (int j = 0; j < n.y; ++j) {
            for (int i = 0; i < n.x; ++i) f(Vec3i(i, j, k));
        }
    }
}

double largest_speed(const SmokeSolver& s) {
    double top = 0;
    for (const Vec3f& v : measure_speeds(s.domain(), s.blocks(), s.state().velocity)) {
        top = std::max(top, static_cast<double>(max_component(v)));
    }
    return top;
}

// --- Taylor-Green vortex: u = sin x cos y exp(-2 nu t), v = -cos x sin y exp(-2 nu t).

struct TaylorGreen {
    double error = 0;         // root mean square of u at the end
    double energy_ratio = 0;  // end over beginning
};

TaylorGreen taylor_green(int resolution, double nu, double time, int steps, AdvectionScheme scheme,
                         Interpolation interpolation = Interpolation::Linear) {
    SmokeParams params;
    params.domain.resolution = resolution;
    params.domain.max = {2 * pi, 2 * pi, 0};
    params.domain.set_all_sides(SideKind::Periodic);
    params.viscosity = nu;
    params.velocity_advection = scheme;
    params.interpolation = interpolation;
    params.pressure_tolerance = 1e-6;
    FluidWorld world;
    world.gravity = {};
    SmokeSolver solver(params, world);
    Job job;
    solver.fill({.velocity =
                     [](const Vec3d& p) {
                         return Vec3d(std::sin(p.x) * std::cos(p.y), -std::cos(p.x) * std::sin(p.y),
                                      0);
                     },
                 .density = nullptr,
                 .temperature = nullptr},
                job);
    const auto energy = [&] {
        double sum = 0;
        for_cells(solver.domain().cells, [&](const Vec3i& c) {
            for (int a = 0; a < 2; ++a) {
                const double u = solver.state().velocity.get(a, c);
                sum += u * u;
            }
        });
        return sum;
    };
    const double before = energy();
    for (int s = 0; s < steps; ++s) solver.step(time / steps, job);
    TaylorGreen result;
    result.energy_ratio = energy() / before;
    const double decay = std::exp(-2 * nu * time);
    for_cells(solver.domain().cells, [&](const Vec3i& c) {
        const Vec3d p = solver.domain().face_center(0, c);
        const double e = solver.state().velocity.get(0, c) - decay * std::sin(p.x) * std::cos(p.y);
        result.error += e * e / (resolution * resolution);
    });
    result.error = std::sqrt(result.error);
    return result;
}

TEST(TaylorGreen, ConvergesWithSecondOrderInSpace) {
    // dt = h^2 / 4: errors of first order in time fall as those of second order in space.
    const double nu = 0.05, time = 0.5;
    std::vector<double> errors;
    for (const int n : {16, 32, 64}) {
        const double h = 2 * pi / n;
        const int steps = static_cast<int>(std::lround(time / (h * h / 4)));
        errors.push_back(taylor_green(n, nu, time, steps, AdvectionScheme::MacCormack).error);
    }
    const double order = std::log2(errors[1] / errors[2]);
    fmt::print("  errors {:.2e} {:.2e} {:.2e}, order {:.2f}\n", errors[0], errors[1], errors[2],
               order);
    RecordProperty("order_in_h", fmt::format("{:.2f}", order));
    EXPECT_GT(order, 1.8);
}

TEST(TaylorGreen, MeasuresTheOrderInTime) {
    std::vector<double> errors;
    for (const int steps : {16, 32}) {
        errors.push_back(taylor_green(128, 0.05, 1.0, steps, AdvectionScheme::MacCormack).error);
    }
    const double order = std::log2(errors[0] / errors[1]);
    fmt::print("  errors {:.2e} {:.2e}, order {:.2f} in dt\n", errors[0], errors[1], order);
    RecordProperty("order_in_dt", fmt::format("{:.2f}", order));
    EXPECT_GT(order, 0.7);
}

TEST(TaylorGreen, LosesEnergyAsViscosityDemands) {
    const double nu = 0.1, time = 1;
    const TaylorGreen flow = taylor_green(64, nu, time, 100, AdvectionScheme::MacCormack);
    EXPECT_NEAR(flow.energy_ratio, std::exp(-4 * nu * time), 0.005);
}

TEST(TaylorGreen, ShowsTheNumericalViscosity) {
    const double time = 1;
    const auto viscosity = [&](int steps, AdvectionScheme scheme, Interpolation interpolation,
                               const char* name) {
        const TaylorGreen flow = taylor_green(64, 0, time, steps, scheme, interpolation);
        const double nu = -std::log(flow.energy_ratio) / (4 * time);
        const std::string key = fmt::format("{}, CFL {:.2g}", name, 64 / (2 * pi * steps));
        fmt::print("  numerical viscosity at 64^2: {:34} {:+.2e} m^2/s\n", key, nu);
        testing::Test::RecordProperty(key, fmt::format("{:.2e}", nu));
        return nu;
    };
    for (const int steps : {20, 160}) {
        const double sl = viscosity(steps, AdvectionScheme::SemiLagrangian, Interpolation::Linear,
                                    "semi-Lagrangian, linear"),
                     cubic = viscosity(steps, AdvectionScheme::SemiLagrangian,
                                       Interpolation::MonotoneCubic, "semi-Lagrangian, cubic"),
                     mac = viscosity(steps, AdvectionScheme::MacCormack, Interpolation::Linear,
                                     "MacCormack, linear");
        // Advecting first and projecting then costs dt / 8 in this flow, whatever the scheme; the
        // rest is the scheme's own.
        const double splitting = time / steps / 8;
        EXPECT_LT(std::abs(mac - splitting), (sl - splitting) / 20);
        EXPECT_LT(std::abs(cubic - splitting), (sl - splitting) / 8);
    }
}

// --- Statics

SmokeParams closed_box(int resolution) {
    SmokeParams params;
    params.domain.resolution = resolution;
    params.domain.set_all_sides(SideKind::NoSlip);
    params.pressure_tolerance = 1e-6;
    params.vorticity_confinement = 3.0;
    return params;
}

TEST(Statics, AmbientAirStaysAtRest) {
    SmokeSolver solver(closed_box(24), {});
    Job job;
    for (int s = 0; s < 3; ++s) EXPECT_EQ(solver.step(0.1, job).max_speed, 0);
}

TEST(Statics, PressureHoldsUniformlyHotAir) {
    SmokeSolver solver(closed_box(32), {});
    Job job;
    solver.fill({.velocity = nullptr,
                 .density = nullptr,
                 .temperature = [](const Vec3d&) { return 400.0; }},
                job);
    const double gain = 9.80665 * (400 - 293.15) / 293.15 * 0.05;  // of free air in a step, m/s
    for (int s = 0; s < 5; ++s) EXPECT_LT(solver.step(0.05, job).max_speed, 1e-5 * gain);
}

TEST(Statics, StratifiedAirStaysAtRest) {
    SmokeSolver solver(closed_box(32), {});
    Job job;
    solver.fill({.velocity = nullptr,
                 .density = nullptr,
                 .temperature = [](const Vec3d& p) { return 293.15 + 50 * p.z; }},
                job);
    for (int s = 0; s < 5; ++s) EXPECT_LT(solver.step(0.05, job).max_speed, 1e-5);
}

TEST(FreeMotion, UniformFlowStaysUniform) {
    for (const SideKind side : {SideKind::Open, SideKind::Periodic}) {
        SmokeParams params;
        params.domain.resolution = 24;
        params.domain.max = {1, 0.7, 0.9};
        params.domain.set_all_sides(side);
        params.initial_velocity = {0.7, -0.4, 0.2};
        params.vorticity_confinement = 5.0;
        SmokeSolver solver(params, {});
        Job job;
        for (int s = 0; s < 5; ++s) solver.step(0.1, job);
        for (int a = 0; a < 3; ++a) {
            for_cells(solver.domain().cells, [&](const Vec3i& c) {
                EXPECT_NEAR(solver.state().velocity.get(a, c), params.initial_velocity[a], 1e-6);
            });
        }
    }
}

TEST(FreeMotion, WindRelaxesExactlyInAnySteps) {
    for (const int steps : {1, 7}) {
        SmokeParams params;
        params.domain.resolution = 16;
        params.domain.set_all_sides(SideKind::Periodic);
        params.wind.velocity = Vec3d(3, 1, 0);
        params.wind.rate = 2.0;
        SmokeSolver solver(params, {});
        Job job;
        for (int s = 0; s < steps; ++s) solver.step(0.5 / steps, job);
        EXPECT_NEAR(solver.state().velocity.get(0, {8, 8, 8}), 3 * (1 - std::exp(-1.0)), 1e-5);
        EXPECT_NEAR(solver.state().velocity.get(1, {8, 8, 8}), 1 - std::exp(-1.0), 1e-5);
    }
}

TEST(Decay, HalvesInItsHalfLifeInAnySteps) {
    for (const int steps : {1, 6}) {
        SmokeParams params = closed_box(16);
        params.density_half_life = 0.5;
        params.temperature_half_life = 0.25;
        FluidWorld world;
        world.gravity = {};
        SmokeSolver solver(params, world);
        Job job;
        solver.fill({.velocity = nullptr,
                     .density = [](const Vec3d&) { return 0.8; },
                     .temperature = [](const Vec3d&) { return 393.15; }},
                    job);
        for (int s = 0; s < steps; ++s) solver.step(0.5 / steps, job);
        EXPECT_NEAR(solver.state().density.values.get({8, 8, 8}), 0.4, 1e-6);
        EXPECT_NEAR(solver.state().temperature.values.get({8, 8, 8}), 25, 1e-4);
    }
}

// Without walls pressure exchanges no momentum with the outside: it grows by buoyancy alone.
TEST(Buoyancy, GivesTheSameImpulseInAnySteps) {
    for (const int steps : {2, 8}) {
        SmokeParams params;
        params.domain.resolution = 32;
        params.domain.set_all_sides(SideKind::Periodic);
        params.density_weight = 0.1;
        SmokeSolver solver(params, {});
        Job job;
        const auto blob = [](const Vec3d& p) {
            const Vec3d d = p - Vec3d(0.5);
            return std::exp(-dot(d, d) / 0.02);
        };
        solver.fill({.velocity = nullptr,
                     .density = [&](const Vec3d& p) { return 0.5 * blob(p); },
                     .temperature = [&](const Vec3d& p) { return 293.15 + 30 * blob(p); }},
                    job);
        const double time = 0.2;
        double force = 0, impulse = 0;
        for_cells(solver.domain().cells, [&](const Vec3i& c) {
            force += 9.80665 * (solver.state().temperature.values.get(c) / 293.15 -
                                0.1 * solver.state().density.values.get(c));
        });
        for (int s = 0; s < steps; ++s) solver.step(time / steps, job);
        for_cells(solver.domain().cells,
                  [&](const Vec3i& c) { impulse += solver.state().velocity.get(2, c); });
        EXPECT_NEAR(impulse / (force * time), 1, 5e-3) << steps;
    }
}

// --- Invariances

// A plume along any axis: axis a of the plume along z is axis (a + turn) mod 3 here.
SmokeSolver make_plume(int turn) {
    const auto turned = [&](const Vec3d& v) {
        Vec3d r;
        for (int a = 0; a < 3; ++a) r[(a + turn) % 3] = v[a];
        return r;
    };
    SmokeParams params;
    params.domain.resolution = 40;
    params.domain.max = turned({0.6, 0.7, 1});
    EmitterParams e;
    e.position = turned({0.31, 0.33, 0.2});
    e.radius = 0.12;
    e.density = Keyed<double>(1);
    e.temperature = Keyed<double>(500);
    e.velocity = Keyed<Vec3d>(turned({0.1, 0.2, 0.5}));
    params.sources = {e};
    params.vorticity_confinement = 4.0;
    params.pressure_tolerance = 1e-6;
    FluidWorld world;
    world.gravity = turned({0, 0, -9.81});
    SolidParams ball;
    ball.position = turned({0.3, 0.35, 0.55});
    ball.radius = 0.1;
    world.solids = {ball};
    return SmokeSolver(params, world);
}

TEST(Invariance, AnyAxisMayBeUp) {
    Job job;
    SmokeSolver reference = make_plume(0);
    for (int s = 0; s < 5; ++s) reference.step(0.05, job);
    ASSERT_GT(largest_speed(reference), 0.5);
    for (const int turn : {1, 2}) {
        SmokeSolver turned = make_plume(turn);
        for (int s = 0; s < 5; ++s) turned.step(0.05, job);
        for_cells(reference.domain().cells, [&](const Vec3i& c) {
            Vec3i d;
            for (int a = 0; a < 3; ++a) d[(a + turn) % 3] = c[a];
            EXPECT_NEAR(reference.state().density.values.get(c),
                        turned.state().density.values.get(d), 1e-4);
            EXPECT_NEAR(reference.state().velocity.get(2, c),
                        turned.state().velocity.get((2 + turn) % 3, d), 2e-4);
        });
    }
}

TEST(Invariance, MirrorImagesMoveAsMirrorImages) {
    SmokeParams params;
    params.domain.resolution = 40;
    params.domain.max = {0.8, 0.8, 1};
    EmitterParams e;
    e.position = Vec3d(0.4, 0.4, 0.2);
    e.radius = 0.12;
    e.density = Keyed<double>(1);
    e.temperature = Keyed<double>(500);
    params.sources = {e};
    params.vorticity_confinement = 4.0;
    params.pressure_tolerance = 1e-6;
    SmokeSolver solver(params, {});
    Job job;
    for (int s = 0; s < 6; ++s) solver.step(0.05, job);
    const Vec3i n = solver.domain().cells;
    for_cells(n, [&](const Vec3i& c) {
        const auto& density = solver.state().density.values;
        EXPECT_NEAR(density.get(c), density.get({n.x - 1 - c.x, c.y, c.z}), 1e-4);
        EXPECT_NEAR(density.get(c), density.get({c.y, c.x, c.z}), 1e-4);
    });
}

TEST(Invariance, TwoDimensionsAreASlabOfThree) {
    const auto make = [](double thickness) {
        SmokeParams params;
        params.domain.resolution = 48;
        params.domain.min = {0, 0, -thickness / 2};
        params.domain.max = {0.8, 1, thickness / 2};
        params.domain.y_min = SideKind::FreeSlip;
        params.domain.z_min = params.domain.z_max = SideKind::Periodic;
        EmitterParams e;
        e.kind = EmitterKind::Box;
        e.position = Vec3d(0.38, 0.2, 0);
        e.size = Vec3d(0.2, 0.1, 10);
        e.density = Keyed<double>(1);
        e.temperature = Keyed<double>(450);
        params.sources = {e};
        params.vorticity_confinement = 4.0;
        params.viscosity = 1e-4;
        params.pressure_tolerance = 1e-6;
        FluidWorld world;
        world.gravity = {0, -9.81, 0};
        SolidParams box;
        box.kind = SolidKind::Box;
        box.position = Vec3d(0.4, 0.55, 0);
        box.size = Vec3d(0.3, 0.1, 10);
        box.rotation = Vec3d(0, 0, 20);
        world.solids = {box};
        return std::pair(params, world);
    };
    const auto [flat, world] = make(0);
    const auto [thick, same] = make(8.0 / 48);
    SmokeSolver two(flat, world), three(thick, same);
    ASSERT_EQ(two.domain().cells, Vec3i(38, 48, 1));
    ASSERT_EQ(three.domain().cells, Vec3i(38, 48, 8));
    Job job;
    for (int s = 0; s < 6; ++s) {
        two.step(0.04, job);
        three.step(0.04, job);
    }
    EXPECT_GT(largest_speed(two), 0.3);
    for_cells(two.domain().cells, [&](const Vec3i& c) {
        const Vec3i d{c.x, c.y, 3};
        EXPECT_NEAR(two.state().density.values.get(c), three.state().density.values.get(d), 2e-4);
        for (int a = 0; a < 2; ++a) {
            EXPECT_NEAR(two.state().velocity.get(a, c), three.state().velocity.get(a, d), 2e-4);
        }
    });
}

TEST(Emitters, GiveTheSameInAnySteps) {
    for (const EmitterMode mode : {EmitterMode::Pull, EmitterMode::Set}) {
        DomainParams params;
        params.resolution = 24;
        const Domain domain(params);
        const BlockMap blocks(domain.map);
        EmitterParams e;
        e.position = Vec3d(0.5);
        e.radius = 0.2;
        e.edge = 0.1;
        e.density = Keyed<double>(1);
        e.temperature = Keyed<double>(400);
        e.velocity = Keyed<Vec3d>(Vec3d(0, 0, 2));
        e.mode = mode;
        e.rate = 5.0;
        const Emitters emitters({e}, 293.15, 1.0 / 24, domain.h);
        std::array<SparseField, 2> density{SparseField(blocks, domain.map),
                                           SparseField(blocks, domain.map)},
            heat = density;
        std::array<FaceField, 2> u{FaceField(domain.map), FaceField(domain.map)};
        const std::array<int, 2> steps{1, 8};
        for (std::size_t i = 0; i < 2; ++i) {
            for (int s = 0; s < steps[i]; ++s) {
                emitters.apply(domain, blocks, 0, 0.05 / steps[i], density[i], heat[i], u[i]);
            }
        }
        const float middle = density[0].values.get({12, 12, 12});
        EXPECT_NEAR(middle, mode == EmitterMode::Set ? 1.0 : 1 - std::exp(-0.25), 1e-6);
        for_cells(domain.cells, [&](const Vec3i& c) {
            EXPECT_NEAR(density[0].values.get(c), density[1].values.get(c), 2e-6);
            EXPECT_NEAR(heat[0].values.get(c), heat[1].values.get(c), 2e-4);
            EXPECT_NEAR(u[0].get(2, c), u[1].get(2, c), 4e-6);
        });
    }
}

TEST(Domain, RoundsToWholeCellsAndRefusesNonsense) {
    DomainParams params;
    params.resolution = 100;
    params.min = {-1, 0, 2};
    params.max = {1, 0.5, 2};
    const Domain flat(params);
    EXPECT_EQ(flat.cells, Vec3i(100, 25, 1));
    EXPECT_TRUE(flat.is_2d());
    EXPECT_NEAR(flat.center_of({0, 0, 0}).z, 2, 1e-12);
    params.max.x = -2;
    EXPECT_THROW(Domain{params}, Error);
    params.max = {1, 1, 4};
    params.resolution = 0;
    EXPECT_THROW(Domain{params}, Error);
    params.resolution = 16384;
    EXPECT_THROW(Domain{params}, Error);
    params.resolution = 10;
    params.x_min = SideKind::Periodic;
    EXPECT_THROW(Domain{params}, Error);
}

TEST(SmokeSolver, RefusesNonsense) {
    SmokeParams params;
    params.domain.resolution = 8;
    Job job;
    EXPECT_THROW(SmokeSolver(params, {}).step(-0.1, job), Error);
    EXPECT_THROW(SmokeSolver(params, {}).step(std::nan(""), job), Error);
    FluidWorld world;
    world.fps = 0;
    EXPECT_THROW(SmokeSolver(params, world), Error);
    params.density_half_life = -1;
    EXPECT_THROW(SmokeSolver(params, {}), Error);
}

}  // namespace
}  // namespace gischt
