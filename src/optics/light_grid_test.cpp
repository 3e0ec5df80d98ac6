// SPDX-License-Identifier: Apache-2.0
#include "optics/light_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"

namespace gischt {
namespace {

// A smooth blob on cells that are not cubes.
ExtinctionGrid blob(const Vec3i& cells) {
    ExtinctionGrid grid{{{-1, -1.5, -2}, {1, 1.5, 2}}, cells, std::vector<float>(volume(cells))};
    for (std::size_t i = 0; i < grid.extinction.size(); ++i) {
        const auto k = static_cast<int>(i);
        const Vec3i c(k % cells.x, k / cells.x % cells.y, k / cells.x / cells.y);
        const Vec3d p = grid.center(c) - Vec3d(0.2, 0.1, -0.3);
        grid.extinction[i] = static_cast<float>(2 * std::exp(-3 * dot(p, p)));
    }
    return grid;
}

const std::vector<LightOrigin> origins{
    {true, normalize(Vec3d(1, 2, 3))},  {true, {0, 0, -1}},
    {true, normalize(Vec3d(-1, 1, 0))}, {false, {3, 2, -4}},
    {false, {0.1, 0.2, 0.3}},           {false, {0.025, 0.025, 0.025}}};

TEST(LightGrid, ExactlyDimsByTheVoxelsInFront) {
    Job job;
    ExtinctionGrid grid{{{0, 0, 0}, {4, 1, 1}}, {4, 1, 1}, {0.1f, 0.2f, 0.3f, 0.4f}};
    const LightGrid light = light_to_cells(grid, {true, {1, 0, 0}}, LightGridMethod::Exact, job);
    EXPECT_FLOAT_EQ(light.transmittance[3], 1);
    EXPECT_FLOAT_EQ(light.transmittance[2], std::exp(-0.4f));
    EXPECT_FLOAT_EQ(light.transmittance[0], std::exp(-0.9f));
    // L = albedo L_light (1 - T_vox) T_ray.
    EXPECT_NEAR(light.shade(grid, {true, {1, 0, 0}}, {1, 0, 0}, 0.5f, 10),
                5 * (1 - std::exp(-0.2)) * std::exp(-0.7), 1e-5);
    // A light inside the row: voxels behind it do not count, its own counts in part.
    const LightOrigin inside{false, {2.75, 0.5, 0.5}};
    const LightGrid near = light_to_cells(grid, inside, LightGridMethod::Exact, job);
    EXPECT_FLOAT_EQ(near.transmittance[2], 1);
    EXPECT_FLOAT_EQ(near.transmittance[3], std::exp(-0.3f * 0.25f));
    EXPECT_FLOAT_EQ(near.transmittance[0], std::exp(-0.2f - 0.3f * 0.75f));
}

TEST(LightGrid, MethodsAgreeOnSmoothMedia) {
    Job job;
    const ExtinctionGrid grid = blob({24, 36, 30});
    for (const LightOrigin& origin : origins) {
        const LightGrid exact = light_to_cells(grid, origin, LightGridMethod::Exact, job);
        for (const auto method : {LightGridMethod::Bresenham, LightGridMethod::Sweep}) {
            const LightGrid other = light_to_cells(grid, origin, method, job);
            double squares = 0, worst = 0;
            for (std::size_t i = 0; i < grid.extinction.size(); ++i) {
                const double d = static_cast<double>(other.transmittance[i]) -
                                 static_cast<double>(exact.transmittance[i]);
                squares += d * d;
                worst = std::max(worst, std::abs(d));
            }
            const double rms = std::sqrt(squares / static_cast<double>(grid.extinction.size()));
            EXPECT_LT(rms, 0.05) << static_cast<int>(method);
            EXPECT_LT(worst, 0.2) << static_cast<int>(method);
        }
    }
}

// In an even medium the depth is the extinction times the way through the box.
TEST(LightGrid, DepthsReachTheCentersOfCells) {
    Job job;
    const ExtinctionGrid grid{{Vec3d(0), {8, 6, 4}}, {16, 6, 4}, std::vector<float>(384, 0.5f)};
    const LightOrigin sun{true, {-1, 0, 0}}, lamp{false, {4.25, 2.5, 1.5}};
    for (const auto method :
         {LightGridMethod::Exact, LightGridMethod::Bresenham, LightGridMethod::Sweep}) {
        const std::vector<float> far = depths_to_centers(grid, sun, method, job);
        const std::vector<float> near = depths_to_centers(grid, lamp, method, job);
        for (int i = 0; i < 16; ++i) {
            EXPECT_NEAR(far[grid.index({i, 3, 1})], 0.5 * (0.5 * i + 0.25), 1e-5);
            EXPECT_NEAR(near[grid.index({i, 2, 1})], 0.5 * std::abs(0.5 * i + 0.25 - 4.25),
                        method == LightGridMethod::Bresenham ? 0.1251 : 1e-5);
        }
        // Bresenham's line has whole voxels: half of one is in doubt at the lamp.
        EXPECT_NEAR(near[grid.index({12, 4, 3})],
                    0.5 * length(grid.center({12, 4, 3}) - lamp.place),
                    method == LightGridMethod::Bresenham ? 0.22 : 1e-5);
    }
}

// Bresenham's and the sweep's errors fall with the size of the cells.
TEST(LightGrid, ConvergesToTheExactLine) {
    Job job;
    for (const auto method : {LightGridMethod::Bresenham, LightGridMethod::Sweep}) {
        double before = 0;
        for (const int n : {8, 16, 32}) {
            const ExtinctionGrid grid = blob({n, n, n});
            const LightOrigin sun{true, normalize(Vec3d(1, 2, 3))};
            const LightGrid a = light_to_cells(grid, sun, LightGridMethod::Exact, job);
            const LightGrid b = light_to_cells(grid, sun, method, job);
            double squares = 0;
            for (std::size_t i = 0; i < grid.extinction.size(); ++i) {
                const double d = static_cast<double>(a.transmittance[i] - b.transmittance[i]);
                squares += d * d;
            }
            const double rms = std::sqrt(squares / static_cast<double>(grid.extinction.size()));
            if (n > 8) {
                EXPECT_LT(rms, 0.7 * before) << static_cast<int>(method);
            }
            before = rms;
        }
    }
}

TEST(LightGrid, IsOneInVacuumAndTheSameOnAnyThreads) {
    Job job;
    ExtinctionGrid grid = blob({9, 10, 11});
    for (const LightOrigin& origin : origins) {
        for (const auto method :
             {LightGridMethod::Exact, LightGridMethod::Bresenham, LightGridMethod::Sweep}) {
            const LightGrid all = light_to_cells(grid, origin, method, job);
            {
                const ThreadLimit one(1);
                EXPECT_EQ(all.transmittance,
                          light_to_cells(grid, origin, method, job).transmittance);
            }
            const ExtinctionGrid nothing{grid.box, grid.cells,
                                         std::vector<float>(grid.extinction.size())};
            for (const float t : light_to_cells(nothing, origin, method, job).transmittance) {
                EXPECT_EQ(t, 1);
            }
        }
    }
}

}  // namespace
}  // namespace gischt
