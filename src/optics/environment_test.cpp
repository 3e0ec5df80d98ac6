// SPDX-License-Identifier: Apache-2.0
#include "optics/environment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "image/color.h"
#include "math/sobol.h"
#include "optics/orientation.h"

namespace gischt {
namespace {

// A dim gradient with a small bright sun off the axes.
const Vec3d sun = normalize(Vec3d{0.5, 0.6, 0.4});
Vec3f sunny(const Vec3d& d) {
    const auto glow = static_cast<float>(std::exp(400 * (dot(d, sun) - 1)));
    return Vec3f{0.2f, 0.3f, 0.5f} * static_cast<float>(1.2 + d.z) + Vec3f{90, 80, 60} * glow;
}

TEST(EnvironmentMap, ShowsThePictureUpright) {
    Image image = Image::rgb(8, 4);
    const auto at = [&](int x, int y) -> float& { return image.channel("R")[image.index(x, y)]; };
    for (int x = 0; x < 8; ++x) at(x, 0) = 5;
    at(3, 2) = 7;  // just left of the middle, below the horizon
    const EnvironmentMap map(image);
    EXPECT_NEAR(map.radiance({0, 0, 1}).x, 5, 1e-6);
    EXPECT_NEAR(map.radiance({0, 0, -1}).x, 0, 1e-6);
    // Half a pixel (22.5 degrees) to the left of +x is counterclockwise from above, towards +y.
    const double turn = radians(22.5), down = radians(22.5);
    const Vec3d d{std::cos(down) * std::cos(turn), std::cos(down) * std::sin(turn),
                  -std::sin(down)};
    EXPECT_NEAR(map.radiance(d).x, 7, 1e-5);
    EXPECT_NEAR(map.radiance({d.x, -d.y, d.z}).x, 0, 1e-5);
}

TEST(EnvironmentMap, SeamIsContinuous) {
    const EnvironmentMap map(64, 32, sunny);
    const double e = 1e-7;
    const Vec3f a = map.radiance(normalize(Vec3d{-1, e, 0.3})),
                b = map.radiance(normalize(Vec3d{-1, -e, 0.3}));
    EXPECT_NEAR(a.x, b.x, 1e-5);
}

TEST(EnvironmentMap, RefusesWhatIsNotFinite) {
    Image image = Image::rgb(8, 4);
    image.channel("G")[3] = std::nanf("");
    EXPECT_THROW(EnvironmentMap{image}, Error);
}

// Importance sampling gives the integrals that a fine sum over the sphere gives, with the little
// noise that makes it worth its name.
TEST(EnvironmentMap, SamplingIsUnbiasedAndQuiet) {
    const EnvironmentMap map(128, 64, sunny);
    Vec3d mean, upward;
    double cells = 0;
    for (int y = 0; y < 1024; ++y) {
        const double v = pi * (y + 0.5) / 1024;
        for (int x = 0; x < 2048; ++x) {
            const double u = 2 * pi * (x + 0.5) / 2048;
            const Vec3d d{std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v)};
            const Vec3d l(map.radiance(d));
            mean += std::sin(v) * l;
            upward += std::sin(v) * std::max(0.0, d.z) * l;
            cells += std::sin(v);
        }
    }
    mean = mean / cells;
    upward = upward * (4 * pi / cells);
    Vec3d sampled;
    double luminance_2 = 0, luminance_1 = 0;
    constexpr int n = 1 << 15;
    for (int i = 0; i < n; ++i) {
        const auto s = map.sample(sobol_2d(std::uint32_t(i), 3));
        ASSERT_GT(s.pdf, 0);
        ASSERT_NEAR(s.pdf, map.pdf(s.direction), 1e-3f * s.pdf);
        const Vec3d weight = Vec3d(s.radiance) / double(s.pdf);
        sampled += std::max(0.0, s.direction.z) * weight / double(n);
        luminance_1 += luminance(weight) / n;
        luminance_2 += luminance(weight) * luminance(weight) / n;
    }
    for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(sampled[a] / upward[a], 1, 2e-3);
        EXPECT_NEAR(double(map.mean()[a]) / mean[a], 1, 1e-3);
    }
    EXPECT_NEAR(luminance_1, 4 * pi * luminance(mean), 2e-3 * 4 * pi * luminance(mean));
    // Luminance over density varies only within a cell of the map.
    EXPECT_LT(std::sqrt(luminance_2 / (luminance_1 * luminance_1) - 1), 0.2);
}

// 200 000 independent directions in 16 x 8 fields of the map: chi-squared against the integral of
// pdf(), by the 99.99 % quantile of Wilson & Hilferty 1931.
TEST(EnvironmentMap, SamplesHaveTheDensityOfPdf) {
    const EnvironmentMap map(96, 48, sunny);
    constexpr int columns = 16, rows = 8, fine = 48, n = 200000;
    std::vector<double> seen(columns * rows), expected(columns * rows);
    for (int i = 0; i < n; ++i) {
        const std::uint64_t key = random_key(11, std::uint64_t(i));
        const Vec3d d = map.sample({random_uniform(key, 0), random_uniform(key, 1)}).direction;
        const double u = std::atan2(d.y, d.x) / (2 * pi) + 0.5, v = std::acos(d.z) / pi;
        seen[size_t(std::min(rows - 1, int(v * rows)) * columns +
                    std::min(columns - 1, int(u * columns)))] += 1;
    }
    double total = 0;
    for (int y = 0; y < rows * fine; ++y) {
        for (int x = 0; x < columns * fine; ++x) {
            const double v = pi * (y + 0.5) / (rows * fine),
                         u = 2 * pi * ((x + 0.5) / (columns * fine) - 0.5);
            const Vec3d d{std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v)};
            const double share =
                double(map.pdf(d)) * std::sin(v) * 2 * pi * pi / (rows * columns * fine * fine);
            expected[size_t(y / fine * columns + x / fine)] += n * share;
            total += share;
        }
    }
    EXPECT_NEAR(total, 1, 1e-3);
    double chi2 = 0;
    for (size_t f = 0; f < seen.size(); ++f) {
        ASSERT_GT(expected[f], 5);
        chi2 += (seen[f] - expected[f]) * (seen[f] - expected[f]) / expected[f];
    }
    const double k = columns * rows - 1, v = 2 / (9 * k);
    EXPECT_LT(chi2, k * std::pow(1 - v + 3.719 * std::sqrt(v), 3));
}

TEST(EnvironmentLight, TurnsWithUpAxisAndRotation) {
    const auto map = std::make_shared<EnvironmentMap>(128, 64, sunny);
    const Transform turn = up_frame({0, 1, 0}) * Transform::rotation({0, 0, 1}, radians(90));
    const EnvironmentLight light(map, turn, Vec3f(2));
    // The map's sun, turned by 90 degrees around its z, then z to y.
    const Vec3d turned{-sun.y, sun.z, -sun.x};
    EXPECT_NEAR(light.radiance(turned).x, 2 * map->radiance(sun).x, 1e-3);
    const LightSample s = light.sample({}, {0.3f, 0.6f});
    EXPECT_NEAR(light.pdf({}, s.direction), s.pdf, 1e-3f * s.pdf);
    EXPECT_NEAR(s.weight.y, light.radiance(s.direction).y / s.pdf, 1e-3f * s.weight.y);
    EXPECT_EQ(light.mean_radiance({}), 2.0f * map->mean());
}

TEST(EnvironmentMap, BlackMapGivesNoLight) {
    const EnvironmentMap map(Image::rgb(16, 8));
    const EnvironmentLight light(std::make_shared<EnvironmentMap>(map), {}, Vec3f(1));
    EXPECT_EQ(light.sample({}, {0.5f, 0.5f}).weight, Vec3f(0));
}

// The harmonics of 1 and of a linear gradient are known: irradiance pi and 2 pi / 3 of the slope;
// a lobe of mean cosine g sees g times the slope.
TEST(Harmonics, KnowGradientsExactly) {
    const EnvironmentMap map(512, 256, [](const Vec3d& d) {
        return Vec3f{1, float(1 + d.z), float(1 + 0.5 * d.x)};
    });
    const Harmonics& h = map.harmonics();
    EXPECT_NEAR(h.mean().x, 1, 1e-4);
    EXPECT_NEAR(h.irradiance({0, 0, 1}).x, pi, 1e-3);
    EXPECT_NEAR(h.irradiance({0, 0, 1}).y, pi * (1 + 2.0 / 3), 1e-3);
    EXPECT_NEAR(h.irradiance({-1, 0, 0}).z, pi * (1 - 1.0 / 3), 1e-3);
    EXPECT_NEAR(h.lobe({0, 0, 1}, 0.7f).y, 1.7, 1e-3);
    EXPECT_NEAR(h.lobe({0, 0, 1}, 0).y, 1, 1e-3);
    EXPECT_NEAR(h.radiance({1, 0, 0}).z, 1.5, 1e-3);
}

}  // namespace
}  // namespace gischt
