// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "fluid/smoke.h"

namespace gischt {
namespace {

SolidParams plane(const Vec3d& at, const Vec3d& normal) {
    SolidParams s;
    s.kind = SolidKind::Plane;
    s.position = at;
    s.normal = normal;
    return s;
}

FluidWorld world_with(std::vector<SolidParams> solids) {
    FluidWorld world;
    world.gravity = {};
    world.solids = std::move(solids);
    return world;
}

// A square of n x n cells, periodic along x, whose channel lies between two planes.
struct Channel {
    SmokeParams params;
    double low, high;

    // The planes cut cells at this share of their height.
    Channel(int n, double offset) : low((n / 8 + offset) / n), high((n - n / 8 - offset) / n) {
        params.domain.resolution = n;
        params.domain.max = {1, 1, 0};
        params.domain.set_all_sides(SideKind::FreeSlip);
        params.domain.x_min = params.domain.x_max = SideKind::Periodic;
        params.solid_slip = SolidSlip::NoSlip;
        params.viscosity = 0.1;
        params.thermal_diffusivity = 0.1;
        params.pressure_tolerance = 1e-6;
    }
    SolidParams floor() const { return plane({0, low, 0}, {0, 1, 0}); }
    SolidParams ceiling() const { return plane({0, high, 0}, {0, -1, 0}); }
};

void run(SmokeSolver& solver, int count, double dt) {
    Job job;
    for (int s = 0; s < count; ++s) solver.step(dt, job);
}

class Offset : public testing::TestWithParam<double> {};

TEST_P(Offset, PoiseuilleFlowIsOfSecondOrder) {
    std::array<double, 3> errors{};
    for (std::size_t r = 0; r < 3; ++r) {
        Channel c(16 << r, GetParam());
        c.params.body_acceleration = Vec3d(0.8, 0, 0);
        SmokeSolver solver(c.params, world_with({c.floor(), c.ceiling()}));
        run(solver, 40, 0.5);  // each divides the error by more than 1.5
        const Domain& d = solver.domain();
        for (int j = 0; j < d.cells.y; ++j) {
            const double y = (j + 0.5) * d.h;
            if (y < c.low || y > c.high) continue;
            const double exact = 0.8 / (2 * 0.1) * (y - c.low) * (c.high - y);
            const double error =
                std::abs(static_cast<double>(solver.state().velocity.get(0, {5, j, 0})) - exact);
            errors[r] = std::max(errors[r], error);
        }
    }
    // What the solvers leave is some 1e-5.
    const double order = std::log2(errors[0] / errors[2]) / 2;
    EXPECT_TRUE(order > 1.8 || errors[0] < 1e-4)
        << order << ": " << errors[0] << ' ' << errors[1] << ' ' << errors[2];
    EXPECT_LT(errors[2], 2e-3 * 0.56);
}

TEST_P(Offset, CouetteFlowIsLinear) {
    Channel c(16, GetParam());
    SolidParams ceiling = c.ceiling();
    ceiling.position = Keyed<Vec3d>({0, 1000}, {Vec3d(0, c.high, 0), Vec3d(700, c.high, 0)});
    SmokeSolver solver(c.params, world_with({c.floor(), ceiling}));
    run(solver, 40, 0.5);
    const Domain& d = solver.domain();
    for (int j = 0; j < d.cells.y; ++j) {
        const double share = ((j + 0.5) * d.h - c.low) / (c.high - c.low);
        if (share < 0 || share > 1) continue;
        // Surfaces nearer than a hundredth of a cell are taken to be that far.
        EXPECT_NEAR(solver.state().velocity.get(0, {3, j, 0}), 0.7 * share, 1e-3);
    }
}

TEST_P(Offset, HeatPassesBetweenSolidsLinearly) {
    Channel c(16, GetParam());
    SolidParams floor = c.floor(), ceiling = c.ceiling();
    floor.temperature = 320.0;
    ceiling.temperature = 280.0;
    SmokeSolver solver(c.params, world_with({floor, ceiling}));
    run(solver, 40, 0.5);
    const Domain& d = solver.domain();
    for (int j = 0; j < d.cells.y; ++j) {
        const double share = ((j + 0.5) * d.h - c.low) / (c.high - c.low);
        if (share < 0 || share > 1) continue;
        const double kelvin =
            static_cast<double>(solver.state().temperature.values.get({3, j, 0})) +
            c.params.ambient_temperature;
        EXPECT_NEAR(kelvin, 320 - 40 * share, 0.05);
    }
}

INSTANTIATE_TEST_SUITE_P(NoSlipSolids, Offset, testing::Values(0.004, 0.13, 0.37, 0.5, 0.81, 0.97));

TEST(SolidField, ASolidOfOneTemperatureAmongInsulatedOnesHeatsTheFluidAlone) {
    // A heated floor under an insulated ceiling: in the end all is as warm as the floor.
    Channel c(16, 0.3);
    SolidParams floor = c.floor();
    floor.temperature = Keyed<double>({0, 1}, {300.0, 330.0});
    SmokeSolver solver(c.params, world_with({floor, c.ceiling()}));
    run(solver, 120, 0.5);
    for (int j = 3; j < 13; ++j) {
        EXPECT_NEAR(static_cast<double>(solver.state().temperature.values.get({3, j, 0})) +
                        c.params.ambient_temperature,
                    330, 0.1);
    }
}

// A shear flow along a tilted wall is linear: what lies behind the surface continues it.
TEST(SolidField, ContinuesShearThroughATiltedNoSlipWall) {
    DomainParams params;
    params.resolution = 32;
    params.max = {1, 1, 0};
    const Domain domain(params);
    const BlockMap blocks(domain.map);
    const Vec3d normal{std::sin(0.5), std::cos(0.5), 0}, along{normal.y, -normal.x, 0},
        on{0.5, 0.41, 0};
    const SolidField solids(domain, blocks, {plane(on, normal)}, SolidSlip::NoSlip);
    FaceField u(domain.map);
    const auto exact = [&](int a, const Vec3i& f) {
        return dot(domain.face_center(a, f) - on, normal) * along[a];
    };
    for (int a = 0; a < 2; ++a) {
        for_cells(domain.faces_of(Box3i{{}, domain.cells}, a), [&](const Vec3i& f) {
            const double distance = dot(domain.face_center(a, f) - on, normal);
            u.ref(a, f) = distance > 0 ? static_cast<float>(exact(a, f)) : 99.0f;
        });
    }
    solids.extrapolate(u);
    int ghosts = 0;
    for (int a = 0; a < 2; ++a) {
        for_cells(Box3i{{4, 4, 0}, {28, 28, 1}}, [&](const Vec3i& f) {
            const double distance = dot(domain.face_center(a, f) - on, normal);
            if (distance > 0 || distance < -1.4 * domain.h) return;
            EXPECT_NEAR(u.get(a, f), exact(a, f), 1e-6);
            ++ghosts;
        });
    }
    EXPECT_GT(ghosts, 40);
}

// --- Meshes.

SolidParams mesh_ball(const Vec3d& at, double radius, int level) {
    SolidParams s;
    s.kind = SolidKind::Mesh;
    s.mesh = std::make_shared<MeshDistance>(ball_mesh(1, level));
    s.position = at;
    s.scale = radius;
    return s;
}

TEST(MeshSolid, CutsFacesAsItsBallDoes) {
    DomainParams params;
    params.resolution = 32;
    const Domain domain(params);
    const BlockMap blocks(domain.map);
    const Vec3d at{0.48, 0.51, 0.53};
    SolidParams sphere;
    sphere.position = at;
    sphere.radius = 0.3;
    const SolidField ball(domain, blocks, {sphere});
    const SolidField mesh(domain, blocks, {mesh_ball(at, 0.3, 4)});
    // A facet of edge e lies at most e^2 / (8 r) below the sphere: with 20 4^4 of them some 0.02
    // cells, and cuts no more than that off a face.
    double largest = 0, mean = 0;
    int cut = 0;
    for (int a = 0; a < 3; ++a) {
        for_cells(domain.faces_of(Box3i{{}, domain.cells}, a), [&](const Vec3i& f) {
            const double with = mesh.fraction().get(a, f), without = ball.fraction().get(a, f);
            if (without == 0 || without == 1) return;
            largest = std::max(largest, std::abs(with - without));
            mean += with - without;
            ++cut;
        });
    }
    EXPECT_GT(cut, 1000);
    EXPECT_LT(largest, 0.05);
    EXPECT_LT(std::abs(mean / cut), 0.02);
}

TEST(MeshSolid, IsWhereItsMotionTakesIt) {
    SolidParams cube;
    cube.kind = SolidKind::Mesh;
    cube.mesh = std::make_shared<MeshDistance>(cube_mesh());
    cube.position = Keyed<Vec3d>({0, 1}, {Vec3d(0), Vec3d(2, 0, 0)});
    cube.rotation = Keyed<Vec3d>({0, 1}, {Vec3d(0), Vec3d(0, 0, 90)});
    cube.scale = Keyed<double>({0, 1}, {1.0, 3.0});
    SolidParams box = cube;
    box.kind = SolidKind::Box;
    box.size = Keyed<Vec3d>({0, 1}, {Vec3d(1), Vec3d(3)});
    for (const double t : {0.0, 0.3, 1.0}) {
        const PlacedSolid a(cube, t), b(box, t);
        for (const Vec3d p : {Vec3d(0.1, 0.2, 0.3), Vec3d(2, 1.7, -0.4), Vec3d(-1, 3, 2)}) {
            EXPECT_NEAR(a.signed_distance(p), b.signed_distance(p), 1e-6);
            EXPECT_EQ(a.is_inside(p), b.is_inside(p));
        }
    }
    EXPECT_TRUE(cube.is_moving());
    // Growing by 2 per second from 1.6 at t = 0.3.
    const Vec3d arm{0.2, 0.1, 0.4}, v = cube.velocity_at(0.3, Vec3d(0.6, 0, 0) + arm);
    const Vec3d turning = cross(Vec3d(0, 0, pi / 2), arm), growing = arm * (2 / 1.6);
    EXPECT_NEAR(length(v - Vec3d(2, 0, 0) - turning - growing), 0, 1e-5);
}

TEST(MeshSolid, DeflectsTheFluid) {
    SmokeParams params;
    params.domain.resolution = 24;
    params.domain.y_min = params.domain.y_max = SideKind::FreeSlip;
    params.initial_velocity = {1, 0, 0};
    params.pressure_tolerance = 1e-6;
    SmokeSolver solver(params, world_with({mesh_ball({0.5, 0.5, 0.5}, 0.2, 3)}));
    Job job;
    const StepStatistics s = solver.step(0.01, job);
    EXPECT_LT(s.max_divergence_dt, 1e-5);
    // Potential flow around a sphere is half as fast again beside it.
    EXPECT_GT(s.max_speed, 1.3);
    EXPECT_LT(s.max_speed, 1.7);
}

TEST(MeshSource, FillsItsVolume) {
    SmokeParams params;
    params.domain.resolution = 32;
    params.domain.set_all_sides(SideKind::FreeSlip);
    EmitterParams e;
    e.kind = EmitterKind::Mesh;
    const Mesh ball = ball_mesh(0.25, 3);
    e.body = std::make_shared<MeshDistance>(ball);
    e.position = Vec3d(0.47, 0.52, 0.5);
    e.density = Keyed<double>(1);
    e.mode = EmitterMode::Set;
    params.sources = {e};
    SmokeSolver solver(params, world_with({}));
    Job job;
    solver.step(1.0 / 24, job);  // a frame: what the edge covers is filled by its share
    EXPECT_NEAR(solver.density_integral() / enclosed_volume(ball), 1, 0.02);
}

TEST(MeshSource, RefusesToBeWithoutAMesh) {
    SmokeParams params;
    params.domain.resolution = 16;
    EmitterParams e;
    e.kind = EmitterKind::Mesh;
    e.density = Keyed<double>(1);
    params.sources = {e};
    EXPECT_THROW(SmokeSolver(params, world_with({})), Error);
    SolidParams s;
    s.kind = SolidKind::Mesh;
    params.sources = {};
    EXPECT_THROW(SmokeSolver(params, world_with({s})), Error);
}

}  // namespace
}  // namespace gischt
