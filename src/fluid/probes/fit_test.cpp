// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gischt {
namespace {

// Points without order in the cube [-1,1]^3.
Vec3d point(int i) {
    const auto part = [&](double ratio) { return 2 * std::fmod((i + 0.5) * ratio, 1.0) - 1; };
    return {part(0.7548776662), part(0.5698402910), part(0.3141592654)};
}

TEST(LocalFit, FindsAQuadraticFromSamplesOfOne) {
    for (const int axes : {2, 3}) {
        for (const bool fixed : {false, true}) {
            const auto f = [&](const Vec3d& p) {
                const double z = axes == 3 ? p.z : 0;
                return 0.3 + 2 * p.x - p.y + 0.5 * z + p.x * p.y - 2 * p.y * p.y + z * p.x + z * z;
            };
            LocalFit fit(axes);
            if (fixed) fit.fix(0.3);
            for (int i = 0; i < 20; ++i) {
                Vec3d p = point(i);
                if (axes == 2) p.z = 0;
                fit.add(p, f(p), 1 + 0.1 * i);
            }
            const LocalFit::Result r = fit.solve();
            EXPECT_NEAR(r.value, 0.3, 1e-10);
            EXPECT_NEAR(r.gradient.x, 2, 1e-10);
            EXPECT_NEAR(r.gradient.y, -1, 1e-10);
            EXPECT_NEAR(r.gradient.z, axes == 3 ? 0.5 : 0, 1e-10);
        }
    }
}

TEST(LocalFit, TakesALowerDegreeWhereSamplesAreFew) {
    LocalFit three(2);
    three.add({0, 0, 0}, 1, 1);
    three.add({1, 0, 0}, 2, 1);
    three.add({0, 1, 0}, 4, 1);
    EXPECT_NEAR(three.solve().value, 1, 1e-12);
    EXPECT_NEAR(three.solve().gradient.y, 3, 1e-12);
    LocalFit two(3);  // a line says nothing about what is beside it
    two.add({1, 0, 0}, 1, 1);
    two.add({1, 0, 0}, 3, 3);
    EXPECT_NEAR(two.solve().value, 2.5, 1e-12);
    EXPECT_EQ(two.solve().gradient, Vec3d());
    EXPECT_EQ(LocalFit(2).solve().value, 0);
}

}  // namespace
}  // namespace gischt
