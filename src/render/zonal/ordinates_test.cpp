// SPDX-License-Identifier: Apache-2.0
// Discrete ordinates against the slab table of van de Hulst 1980 and others.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "render/zonal/ordinates.h"

namespace gischt {
namespace {

constexpr EnclosureSide open_side = EnclosureSide::Open, mirror = EnclosureSide::Mirror;

struct SlabLight {
    double reflectance, transmittance;
};

// A slab between z = 0 and 1, lit from below along z.
SlabLight slab(double g, double albedo, double tau, int zones) {
    Enclosure e;
    e.grid = ZoneGrid::even({{0, 0, 0}, {0.1, 0.1, 1}}, {1, 1, zones}, static_cast<float>(tau),
                            static_cast<float>(albedo));
    e.sides = {mirror, mirror, mirror, mirror, open_side, open_side};
    const OrdinateSet set(8, 4);
    const PhaseFunction phase = HenyeyGreensteinPhase{static_cast<float>(g)};
    std::vector<Vec3f> source(e.grid.size() * set.size());
    const double h = 1.0 / zones;
    for (int z = 0; z < zones; ++z) {
        const double light = std::exp(-tau * z * h) * (1 - std::exp(-tau * h)) / (tau * h);
        double norm = 0;
        for (std::size_t m = 0; m < set.size(); ++m) {
            norm += set.weight[m] * double(value(phase, float(set.direction[m].z)));
        }
        for (std::size_t m = 0; m < set.size(); ++m) {
            source[static_cast<std::size_t>(z) * set.size() + m] = Vec3f(static_cast<float>(
                albedo * tau * light * double(value(phase, float(set.direction[m].z))) / norm));
        }
    }
    Job job;
    const OrdinateSolution light =
        solve_ordinates(e, set, scattering_kernel(set, phase), source, {}, {}, job);
    return {double(light.leaving[e.first_side_cell(4)].x) / 0.01,
            double(light.leaving[e.first_side_cell(5)].x) / 0.01 + std::exp(-tau)};
}

TEST(ZonalOrdinates, SlabsReflectAndTransmitWhatTheTableSays) {
    struct Case {
        double g, albedo, tau, reflectance, transmittance;
    };
    for (const Case& c : {Case{0, 0.9, 1, 0.26741, 0.59163}, Case{0.5, 0.9, 1, 0.12979, 0.73909},
                          Case{0.5, 0.9, 2, 0.20451, 0.52327}, Case{0.75, 0.9, 1, 0.05595, 0.82792},
                          Case{0.75, 0.9, 2, 0.09739, 0.66096}, Case{0.75, 1, 1, 0.07878, 0.92122},
                          Case{-0.5, 0.9, 1, 0.36729, 0.50185}}) {
        const SlabLight light = slab(c.g, c.albedo, c.tau, 16);
        const std::string name = fmt::format("g {} albedo {} tau {}", c.g, c.albedo, c.tau);
        EXPECT_NEAR(light.reflectance, c.reflectance, 0.005 * c.reflectance) << name;
        EXPECT_NEAR(light.transmittance, c.transmittance, 0.005 * c.transmittance) << name;
    }
}

TEST(ZonalOrdinates, SetCoversTheSphereAndMapsOntoItself) {
    const OrdinateSet set(4, 3);
    double area = 0;
    Vec3d squares;
    for (std::size_t m = 0; m < set.size(); ++m) {
        area += set.weight[m];
        squares += set.weight[m] * set.direction[m] * set.direction[m];
        for (int flips = 0; flips < 8; ++flips) {
            const Vec3d& image = set.direction[set.flipped(m, static_cast<std::uint8_t>(flips))];
            for (int a = 0; a < 3; ++a) {
                const double sign = flips >> a & 1 ? -1 : 1;
                EXPECT_NEAR(image[a], sign * set.direction[m][a], 1e-12);
            }
        }
    }
    EXPECT_NEAR(area, 4 * pi, 1e-10);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(squares[a], 4 * pi / 3, 1e-10);
}

TEST(ZonalOrdinates, PhaseTooSharpForTheOrdinatesIsRefused) {
    EXPECT_THROW(scattering_kernel(OrdinateSet(2, 2), HenyeyGreensteinPhase{0.95f}), Error);
    EXPECT_NO_THROW(scattering_kernel(OrdinateSet(4, 4), HenyeyGreensteinPhase{0.5f}));
}

}  // namespace
}  // namespace gischt
