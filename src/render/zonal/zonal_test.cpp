// SPDX-License-Identifier: Apache-2.0
// The zonal method against closed forms and published solutions of enclosures.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/path/test_views.h"
#include "render/zonal/zone_solver.h"

namespace gischt {
namespace {

using namespace path_test;

constexpr EnclosureSide open_side = EnclosureSide::Open, mirror = EnclosureSide::Mirror;

// A layer between z = 0 and 1 with mirrors around: one zone wide, so that it is one-dimensional.
Enclosure layer(int zones, double tau, double albedo, int lines = 4096) {
    Enclosure e;
    e.grid = ZoneGrid::even({{0, 0, 0}, {0.1, 0.1, 1}}, {1, 1, zones}, static_cast<float>(tau),
                            static_cast<float>(albedo));
    e.sides = {mirror, mirror, mirror, mirror, open_side, open_side};
    e.lines = lines;
    return e;
}

Enclosure cube(int zones, double extinction, double albedo, int lines) {
    Enclosure e;
    e.grid = ZoneGrid::even({{0, 0, 0}, {1, 1, 1}}, Vec3i(zones), static_cast<float>(extinction),
                            static_cast<float>(albedo));
    e.lines = lines;
    return e;
}

// W per area of a side.
double exitance(const Enclosure& e, const std::vector<Vec3f>& leaving, int side) {
    double sum = 0;
    for (std::size_t i = e.first_side_cell(side); i < e.first_side_cell(side + 1); ++i) {
        sum += double(leaving[i].x);
    }
    const Vec3d size = e.grid.box.size();
    return sum / (size[(side / 2 + 1) % 3] * size[(side / 2 + 2) % 3]);
}

std::vector<Vec3f> glow(const Enclosure& e, double radiance) {
    std::vector<Vec3f> source(e.elements());
    for (std::size_t i = 0; i < e.grid.size(); ++i) {
        source[i] = (e.grid.extinction[i] - e.grid.scattering[i]) * static_cast<float>(radiance);
    }
    return source;
}

// Isothermal grey layer of 1273.15 K between cold black walls: kW/m^2 (1 - 2 E3(tau)) sigma T^4.
TEST(ZonalEnclosure, IsothermalLayerGivesOffWhatTheExponentialIntegralSays) {
    const double power = 5.67e-8 * std::pow(1273.15, 4) / 1000;
    for (const auto& [tau, truth] : {std::pair{0.1, 24.9403}, {1.0, 116.2891}}) {
        const Enclosure e = layer(8, tau, 0);
        Job job;
        const ZoneSweep sweep(e, job);
        const ArrivingLight light = sweep(glow(e, power / pi), true);
        for (const int side : {4, 5}) {
            EXPECT_NEAR(exitance(e, light.leaving, side), truth, 0.005 * truth) << tau;
        }
    }
}

// Black plates with a medium in radiative equilibrium between them, which is one that scatters all
// (Heaslet & Warming 1965): net flux over the difference of the plates' exitances.
TEST(ZonalEnclosure, RadiativeEquilibriumIsThatOfHeasletAndWarming) {
    for (const auto& [tau, truth] : {std::pair{0.5, 0.7042}, {1.0, 0.5534}}) {
        Enclosure e = layer(32, tau, 1);
        e.incoming[4] = Vec3f(static_cast<float>(1 / pi));
        Job job;
        const ZoneSweep sweep(e, job);
        for (const ZoneSolver solver : {ZoneSolver::Exchange, ZoneSolver::Sweeps}) {
            const ZoneSolution light =
                solve_zones(sweep, std::vector<Vec3f>(e.elements()), solver, {}, job);
            EXPECT_NEAR(exitance(e, light.leaving, 5), truth, 0.005 * truth) << tau;
            // What does not go through comes back.
            EXPECT_NEAR(exitance(e, light.leaving, 4), 1 - truth, 0.005 * truth) << tau;
        }
    }
}

// The net flux of flat zones converges with the square of their size: four times as many zones take
// the error to a sixteenth; the lines' own error is the same for all.
TEST(ZonalEnclosure, ConvergesWithTheSquareOfTheZones) {
    double flux[4];
    int i = 0;
    for (const int zones : {2, 4, 8, 64}) {
        Enclosure e = layer(zones, 1, 1, 16384);
        e.incoming[4] = Vec3f(static_cast<float>(1 / pi));
        Job job;
        const ZoneSweep sweep(e, job);
        const ZoneSolution light = solve_zones(sweep, std::vector<Vec3f>(e.elements()),
                                               ZoneSolver::Sweeps, {.tolerance = 1e-6}, job);
        flux[i++] = exitance(e, light.leaving, 5);
    }
    const double first = std::log2((flux[0] - flux[3]) / (flux[1] - flux[3])),
                 second = std::log2((flux[1] - flux[3]) / (flux[2] - flux[3]));
    RecordProperty("orders", fmt::format("{} {}", first, second));
    EXPECT_GT(first, 1.7);
    EXPECT_GT(second, 1.7);
}

// An isothermal ball of optical diameter 1 gives off 0.471518 of a black one. Cells at its surface
// are filled partly.
TEST(ZonalEnclosure, IsothermalSphereHasTheEmissivityOfTheClosedForm) {
    Job job;
    Enclosure e;
    const auto ball = solid(Region::sphere({0, 0, 0}, 0.5), coefficients(Vec3d(1), Vec3d(0)));
    const std::vector<MediumPtr> media{ball};
    e.grid = make_zones(media, {Vec3d(-0.5), Vec3d(0.5)}, Vec3i(24), 6, ZoneScattering::Plain, job);
    e.lines = 64;
    const ZoneSweep sweep(e, job);
    const ArrivingLight light = sweep(glow(e, 1 / pi), true);
    double power = 0;
    for (const Vec3f& w : light.leaving) power += double(w.x);
    EXPECT_NEAR(power / pi, 0.471518, 0.005 * 0.471518);  // the ball's area is pi
}

// A square of isothermal gas, kappa L = 1, between cold black walls and mirrors along its axis:
// flux on the middle of a wall over sigma T^4.
TEST(ZonalEnclosure, IsothermalSquareHeatsTheMiddleOfItsWalls) {
    Enclosure e;
    e.grid = ZoneGrid::even({{0, 0, 0}, {1, 1, 0.1}}, {15, 15, 1}, 1, 0);
    e.sides = {open_side, open_side, open_side, open_side, mirror, mirror};
    e.lines = 4096;
    Job job;
    const ZoneSweep sweep(e, job);
    const ArrivingLight light = sweep(glow(e, 1 / pi), true);
    for (int side = 0; side < 4; ++side) {
        const std::size_t middle = e.first_side_cell(side) + 7;
        EXPECT_NEAR(double(light.leaving[middle].x) * 15 / 0.1, 0.63594, 0.005 * 0.63594) << side;
    }
}

// Where all that comes from outside is 1, everything is 1, whatever is inside: no light is made or
// lost by the quadrature.
TEST(ZonalEnclosure, FurnaceIsEvenToRounding) {
    Enclosure e = cube(6, 3, 1, 16);
    for (std::size_t i = 0; i < e.grid.size(); ++i) {
        e.grid.extinction[i] *= static_cast<float>(i % 5);
        e.grid.scattering[i] = e.grid.extinction[i];
    }
    e.incoming.fill(Vec3f(1));
    Job job;
    const ZoneSweep sweep(e, job);
    for (const ZoneSolver solver : {ZoneSolver::Exchange, ZoneSolver::Sweeps}) {
        const ZoneSolution light =
            solve_zones(sweep, std::vector<Vec3f>(e.elements()), solver, {.tolerance = 1e-5}, job);
        for (const Vec3f& v : light.arriving) ASSERT_NEAR(v.x, 1, 1e-3);
    }
}

// Rows of the matrix, with what comes from outside, fill what the zone takes; the matrix is
// symmetric, and gives what sweeps give.
TEST(ZonalEnclosure, ExchangeFactorsConserveAndAreReciprocal) {
    Enclosure e = cube(4, 2, 1, 32);
    e.incoming.fill(Vec3f(1));
    Job job;
    const ZoneSweep sweep(e, job);
    const ExchangeMatrix matrix(e, std::vector<bool>(e.elements(), true), 1 << 30, job);
    const ArrivingLight outside = sweep(std::vector<Vec3f>(e.elements()), true);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        double sum = double(outside.at[i].x);
        for (std::size_t j = 0; j < matrix.size(); ++j) {
            const float g = matrix.row(i, 0)[j];
            sum += double(g) * double(e.grid.extinction[j].x);
            EXPECT_NEAR(g, matrix.row(j, 0)[i], 1e-5f * g);
        }
        EXPECT_NEAR(sum / double(sweep.measure()[i]), 1, 1e-4);
    }
    std::vector<Vec3f> source(e.elements(), Vec3f(0.5f));
    const ZoneSolution a = solve_zones(sweep, source, ZoneSolver::Exchange, {}, job),
                       b = solve_zones(sweep, source, ZoneSolver::Sweeps, {}, job);
    for (std::size_t i = 0; i < a.arriving.size(); ++i) {
        EXPECT_NEAR(a.arriving[i].x, b.arriving[i].x, 1e-3f * a.arriving[i].x);
    }
}

// Of zones that are far apart: volumes times f = transmittance over the square of the distance, and
// to the second order of their size h that times 1 + h^2/12 lap f / f; in the mean over all pairs
// that lie like that.
TEST(ZonalEnclosure, ExchangeFactorsOfDistantZonesAreThoseOfPoints) {
    const Enclosure e = cube(5, 2, 1, 1024);
    Job job;
    const ExchangeMatrix matrix(e, std::vector<bool>(e.elements(), true), 1 << 30, job);
    const double far = 0.8, f = std::exp(-2 * far) / (far * far);
    const double slope = -2 - 2 / far,
                 laplacian = slope * slope + 2 / (far * far) + 2 * slope / far;
    const double truth = f * (1 + 0.04 / 12 * laplacian) / (125 * 125);
    double mean = 0;
    for (std::size_t row = 0; row < 25; ++row) mean += double(matrix.row(5 * row, 0)[5 * row + 4]);
    EXPECT_NEAR(mean / 25, truth, 0.03 * truth);
}

// The volumes that lines measure are the true ones, the better the more lines.
TEST(ZonalEnclosure, LinesMeasureVolumes) {
    Job job;
    const Enclosure few = cube(4, 2, 1, 64), many = cube(4, 2, 1, 4096);
    const double one = ZoneSweep(few, job).measure_error(),
                 other = ZoneSweep(many, job).measure_error();
    EXPECT_LT(other, 0.02);
    EXPECT_LT(other, 0.25 * one);
}

TEST(ZonalEnclosure, MatrixBeyondTheLimitIsRefused) {
    const Enclosure e = cube(4, 2, 1, 4);
    Job job;
    EXPECT_THROW(ExchangeMatrix(e, std::vector<bool>(e.elements(), true), 1000, job), Error);
}

// The same bits on one thread and on many.
TEST(ZonalEnclosure, ThreadsDoNotMatter) {
    Enclosure e = cube(6, 3, 0.9, 16);
    Job job;
    const std::vector<Vec3f> source(e.elements(), Vec3f(1));
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        const ZoneSweep sweep(e, job);
        return solve_zones(sweep, source, ZoneSolver::Sweeps, {}, job);
    };
    const ZoneSolution one = run(1), many = run(4);
    EXPECT_EQ(one.arriving, many.arriving);
    EXPECT_EQ(one.leaving, many.leaving);
}

}  // namespace
}  // namespace gischt
