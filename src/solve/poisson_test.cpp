// SPDX-License-Identifier: Apache-2.0
#include "solve/poisson.h"

#include <gtest/gtest.h>

namespace gischt {
namespace {

TEST(Poisson, Smoke) {
    const auto map = TileMap::box({64, 64, 64});
    for (const Side side : {Side::Wall, Side::Open, Side::Periodic}) {
        PoissonSolver solver(map, {side, side, side, side, side, side});
        TileField<float> b(map), x(map);
        b.ref({20, 30, 40}) = 1;
        b.ref({40, 35, 23}) = -1;
        Job job;
        const SolveResult r = solver.solve(b, x, 1e-6, 50, job);
        printf("%d %g\n", r.iterations, r.residual);
    }
}

}  // namespace
}  // namespace gischt
