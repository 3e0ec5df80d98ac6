// SPDX-License-Identifier: Apache-2.0
#include "optics/blackbody.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "image/color.h"
#include "math/quadrature.h"
#include "optics/spectrum.h"

namespace gischt {
namespace {

TEST(Spectrum, FlatSpectrumIsOneOneOne) {
    const double per_nm = 1 / (visible_max - visible_min);
    const Vec3d xyz = spectrum_to_xyz([&](double) { return per_nm; });
    EXPECT_NEAR(xyz.y, 1, 1e-12);
    EXPECT_NEAR(chromaticity(xyz).x, 1.0 / 3, 2e-5);
    EXPECT_NEAR(chromaticity(xyz).y, 1.0 / 3, 2e-5);
    const Vec3d rgb = adapted_xyz_to_rgb(xyz);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(rgb[a], 1, 1e-9);
    EXPECT_NEAR(luminance(rgb), 1, 1e-9);
    const Vec3d back = rgb_to_adapted_xyz(rgb);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(back[a], xyz[a], 1e-12);
}

// The published integral of the observer over 5 nm steps, each about 21.371 (CIE 15:2004), guards
// against a wrong digit in the table; the peak and the ends guard its alignment.
TEST(Spectrum, ObserverTableIsTheStandards) {
    Vec3d sum;
    for (int i = 0; i < observer_entries; ++i) sum += observer(visible_min + observer_step * i);
    EXPECT_NEAR(sum.x, 21.3714, 3e-4);
    EXPECT_NEAR(sum.y, 21.3711, 3e-4);
    EXPECT_NEAR(sum.z, 21.3715, 1e-3);
    EXPECT_EQ(observer(555).y, 1);
    EXPECT_NEAR(observer(557.5).y, 0.9975, 1e-12);
    EXPECT_EQ(observer(379).y, 0);
    EXPECT_EQ(observer(781).y, 0);
}

// Chromaticities of the Planckian locus with c2 = 0.014388 m K (Wyszecki & Stiles 1982, and CIE
// illuminant A at 2856 K).
TEST(Blackbody, LiesOnThePlanckianLocus) {
    struct Point {
        double kelvin, x, y;
    };
    for (const Point& p :
         {Point{1000, .6528, .3444}, Point{2000, .5267, .4133}, Point{2856, .4476, .4074},
          Point{4000, .3805, .3768}, Point{5000, .3451, .3516}, Point{6500, .3135, .3237},
          Point{10000, .2807, .2884}}) {
        const Vec2d c = chromaticity(blackbody_xyz(p.kelvin));
        EXPECT_NEAR(c.x, p.x, 3e-4) << p.kelvin;
        EXPECT_NEAR(c.y, p.y, 3e-4) << p.kelvin;
    }
}

TEST(Blackbody, TotalIsStefanBoltzmann) {
    const GaussLegendre rule(24);
    for (const double kelvin : {300.0, 1273.15, 5778.0}) {
        // Panels even in log(wavelength) from 1/50 to 1000 times the peak.
        const double peak = 2.897771955e6 / kelvin;
        double total = 0;
        for (int panel = 0; panel < 60; ++panel) {
            const double a = std::log(peak / 50) + panel * std::log(5e4) / 60;
            total += rule.integrate(a, a + std::log(5e4) / 60, [&](double log_lambda) {
                return std::exp(log_lambda) * planck_radiance(std::exp(log_lambda), kelvin);
            });
        }
        EXPECT_NEAR(pi * total / (stefan_boltzmann * std::pow(kelvin, 4)), 1, 1e-6) << kelvin;
    }
}

TEST(Blackbody, PeakShiftsAsWienSays) {
    for (const double kelvin : {1500.0, 5778.0}) {
        const double peak = 2.897771955e6 / kelvin;
        const double top = planck_radiance(peak, kelvin);
        EXPECT_GT(top, planck_radiance(peak * 1.001, kelvin));
        EXPECT_GT(top, planck_radiance(peak * 0.999, kelvin));
    }
}

TEST(Blackbody, TableAgreesWithTheIntegralAndGrows) {
    const BlackbodyTable table;
    EXPECT_EQ(table.radiance(499), Vec3f(0));
    EXPECT_EQ(table.radiance(-1), Vec3f(0));
    EXPECT_EQ(table.radiance(std::nanf("")), Vec3f(0));
    Vec3f before(0);
    for (double kelvin = 501; kelvin < 15000; kelvin *= 1.0037) {
        const Vec3f looked_up = table.radiance(static_cast<float>(kelvin));
        const Vec3f exact = blackbody_radiance(double(float(kelvin)));
        for (int a = 0; a < 3; ++a) {
            // Relative, except where blue enters the gamut.
            EXPECT_NEAR(looked_up[a], exact[a], 1e-4f * exact[a] + 1e-5f * exact.x) << kelvin;
            EXPECT_GE(looked_up[a], before[a]) << kelvin;
        }
        before = looked_up;
    }
    EXPECT_EQ(table.radiance(20000), table.radiance(15000));
}

// A flame is orange, a tungsten lamp warm, the noon sun about white, the hot sky bluish.
TEST(Blackbody, ColorsLookRight) {
    for (const double kelvin : {1200.0, 2856.0, 5455.0, 10000.0}) {
        EXPECT_NEAR(luminance(blackbody_color(kelvin)), 1, 1e-5);
    }
    EXPECT_GT(blackbody_color(1200).x, 3 * blackbody_color(1200).y);
    EXPECT_GT(blackbody_color(2856).x, 2 * blackbody_color(2856).z);
    const Vec3f sun = blackbody_color(5455);
    EXPECT_NEAR(max_component(sun) / min_component(sun), 1, 0.1);
    EXPECT_GT(blackbody_color(10000).z, blackbody_color(10000).x);
}

}  // namespace
}  // namespace gischt
