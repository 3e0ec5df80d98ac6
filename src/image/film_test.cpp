// SPDX-License-Identifier: Apache-2.0
#include "image/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace gischt {
namespace {

TEST(Film, MeansOfSamples) {
    Film film(2, 1, ReconstructionFilter(FilterKind::Box), {"direct.R"});
    const float one[] = {1}, three[] = {3};
    film.add(0, 0, {{1, 2, 3}, 1, 4}, one);
    film.add(0, 0, {{3, 4, 5}, 0}, three);
    const Image image = film.image();
    EXPECT_EQ(image.channel("R")[0], 2);
    EXPECT_EQ(image.channel("B")[0], 4);
    EXPECT_EQ(image.channel("A")[0], 0.5f);
    EXPECT_EQ(image.channel("Z")[0], 4);  // of the samples that hit
    EXPECT_EQ(image.channel("direct.R")[0], 2);
    EXPECT_EQ(image.channel("R")[1], 0);
    EXPECT_EQ(image.channel("Z")[1], std::numeric_limits<float>::infinity());
    EXPECT_EQ(film.total_samples(), 2);
}

TEST(Film, ConstantRadianceStaysConstantWithEveryFilter) {
    for (const FilterKind kind : {FilterKind::Box, FilterKind::Gaussian, FilterKind::Mitchell,
                                  FilterKind::BlackmanHarris}) {
        Film film(8, 8, ReconstructionFilter(kind));
        for (std::uint32_t i = 0; i < 64 * 64; ++i) {
            const std::uint64_t key = random_key(5, i);
            const auto s = film.sample_filter({random_uniform(key, 0), random_uniform(key, 1)});
            film.add(static_cast<int>(i % 8), static_cast<int>(i / 8 % 8),
                     {Vec3f(0.75f), 1, 1, s.weight});
        }
        const Image image = film.image();
        for (const float v : image.channel("G")) EXPECT_NEAR(v, 0.75f, 1e-6);
        EXPECT_LT(film.noise(), 1e-6);
    }
}

// A filtered edge: the mean over samples equals the filter's integral on the bright side, with the
// negative lobes of Mitchell too.
TEST(Film, FiltersAnEdge) {
    for (const FilterKind kind : {FilterKind::Gaussian, FilterKind::Mitchell}) {
        const ReconstructionFilter filter(kind);
        Film film(1, 1, filter);
        const double edge = 0.6;  // bright where x > edge, from the pixel's centre
        const int n = 200000;
        for (int i = 0; i < n; ++i) {
            const std::uint64_t key = random_key(6, static_cast<std::uint64_t>(i));
            const auto s = film.sample_filter({random_uniform(key, 0), random_uniform(key, 1)});
            film.add(0, 0, {Vec3f(s.offset.x > edge ? 1.0f : 0.0f), 1, 1, s.weight});
        }
        double above = 0, all = 0;
        for (int i = 0; i < 10000; ++i) {
            const double x = (i + 0.5) / 5000 - 1;
            const double f = filter.profile(x * filter.radius());
            all += f;
            if (x * filter.radius() > edge) above += f;
        }
        const Image image = film.image();
        EXPECT_NEAR(image.channel("R")[0], above / all, 5 / std::sqrt(n));
    }
}

TEST(Film, NoiseEstimateIsTheSpreadOfPixelMeans) {
    // Uniform samples in [0, 1): variance 1/12, mean 1/2.
    const int size = 64, n = 16;
    Film film(size, size, ReconstructionFilter(FilterKind::Box));
    EXPECT_TRUE(std::isinf(film.noise()));
    parallel_for(size * size, 64, [&](int p) {
        for (std::uint32_t s = 0; s < n; ++s) {
            const std::uint64_t key = random_key(9, static_cast<std::uint64_t>(p), s);
            film.add(p % size, p / size, {Vec3f(random_uniform(key, 0))});
        }
    });
    const double expected = std::sqrt(1.0 / 12 / n) / 0.5;
    EXPECT_NEAR(film.noise(), expected, 0.02 * expected);
    double spread = 0;
    const Image image = film.image();
    for (const float v : image.channel("G")) spread += (v - 0.5) * (v - 0.5);
    EXPECT_NEAR(std::sqrt(spread / (size * size)) / 0.5, expected, 0.05 * expected);
}

TEST(Film, MergesPartsOfTheSamples) {
    Film whole(4, 4), first(4, 4), second(4, 4);
    for (std::uint32_t s = 0; s < 32; ++s) {
        for (int p = 0; p < 16; ++p) {
            const float v = static_cast<float>(p * 32) + static_cast<float>(s);  // exact in double
            Film& part = s < 13 ? first : second;
            for (Film* film : {&whole, &part}) film->add(p % 4, p / 4, {Vec3f(v), 0.5f, v});
        }
    }
    first.merge(second);
    EXPECT_EQ(first.image(), whole.image());
    EXPECT_EQ(first.noise(), whole.noise());
    EXPECT_THROW(first.merge(Film(4, 5)), Error);
}

TEST(Film, RejectsWhatIsNotFiniteAndSaysSo) {
    Film film(1, 1);
    film.add(0, 0, {Vec3f(2)});
    film.add(0, 0, {Vec3f(std::numeric_limits<float>::quiet_NaN())});
    film.add(0, 0, {Vec3f(std::numeric_limits<float>::infinity())});
    film.add(0, 0, {Vec3f(2)});
    EXPECT_EQ(film.rejected(), 2);
    const Image image = film.image();
    EXPECT_EQ(image.channel("R")[0], 1);
}

// Values over 18 orders of magnitude, whose sum in double depends on the order.
TEST(Film, AnySplitAndOrderGivesTheSameBits) {
    const int size = 6, n = 200;
    auto add = [&](Film& film, int p, int s) {
        const std::uint64_t key =
            random_key(3, static_cast<std::uint64_t>(p), static_cast<std::uint64_t>(s));
        auto value = [&](std::uint32_t d) {
            return std::exp(20 * random_uniform(key, d)) * random_uniform(key, 20 + d) - 1e-9f;
        };
        const float extra[] = {value(5), -value(6)};
        film.add(p % size, p / size,
                 {{value(0), value(1), value(2)},
                  random_uniform(key, 3),
                  random_uniform(key, 7) < 0.2f ? std::numeric_limits<float>::infinity() : value(4),
                  random_uniform(key, 8) < 0.1f ? -1.0f : 1.0f},
                 extra);
    };
    const ReconstructionFilter mitchell(FilterKind::Mitchell);
    const std::vector<std::string> names{"direct.R", "motion.X"};
    Film whole(size, size, mitchell, names);
    for (int s = 0; s < n; ++s) {
        for (int p = 0; p < size * size; ++p) add(whole, p, s);
    }
    for (std::uint64_t trial = 0; trial < 4; ++trial) {
        std::vector<Film> parts(5, Film(size, size, mitchell, names));
        for (int p = 0; p < size * size; ++p) {
            for (int i = 0; i < n; ++i) {
                const int s = (i * 73 + static_cast<int>(trial) * 31) % n;  // 73, 200: coprime
                const auto part = random_bits(random_key(trial, static_cast<std::uint64_t>(s)), 0);
                add(parts[part % 5], p, s);
            }
        }
        for (std::size_t i = 1; i < 5; ++i) parts[0].merge(parts[i]);
        EXPECT_EQ(parts[0].image(), whole.image());
        EXPECT_EQ(parts[0].noise(), whole.noise());
        for (int p = 0; p < size * size; ++p) {
            EXPECT_EQ(parts[0].variance(p % size, p / size), whole.variance(p % size, p / size));
        }
    }
}

TEST(Film, RejectsWhatItsSumsCannotHold) {
    Film film(1, 1, ReconstructionFilter(FilterKind::Box), {"albedo.R"});
    const float one[] = {1}, large[] = {1e15f};
    film.add(0, 0, {Vec3f(1e11f)}, one);
    film.add(0, 0, {Vec3f(1e12f)}, one);
    film.add(0, 0, {Vec3f(1)}, large);
    film.add(0, 0, {Vec3f(1), 1, -std::numeric_limits<float>::infinity()}, one);
    EXPECT_EQ(film.rejected(), 3);
    const Image image = film.image();
    EXPECT_FLOAT_EQ(image.channel("R")[0], 0.25e11f);
    EXPECT_FLOAT_EQ(image.channel("albedo.R")[0], 0.25f);
}

// Squares of dark and of bright pictures keep their variance: uniform numbers in [0, scale).
TEST(Film, NoiseDoesNotDependOnTheScaleOfTheLight) {
    double at_one = 0;
    for (const float scale : {1.0f, 0x1p-24f, 0x1p36f}) {
        Film film(1, 1, ReconstructionFilter(FilterKind::Box));
        for (std::uint32_t s = 0; s < 1000; ++s) {
            film.add(0, 0, {Vec3f(scale * random_uniform(random_key(2), s))});
        }
        if (scale == 1) at_one = film.noise();
        // 2^-64 cut from each square, against 2^-48 / 12 of variance.
        EXPECT_NEAR(film.noise(), at_one, 1e-4 * at_one);
    }
}

}  // namespace
}  // namespace gischt
