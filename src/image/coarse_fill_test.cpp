// SPDX-License-Identifier: Apache-2.0
#include "image/coarse_fill.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "image/coarse_order.h"

namespace gischt {
namespace {

constexpr int width = 100, height = 68;  // no multiples of 8

// The samples of a picture down to blocks of that edge; `noise` is their standard deviation.
template <class Value>
Film first_samples(int edge, const Value& value, float noise = 0) {
    Film film(width, height, ReconstructionFilter(FilterKind::Box));
    const CoarseOrder order(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (!order.is_first(x, y, edge)) continue;
            const std::uint64_t key = random_key(1, static_cast<std::uint64_t>(y * width + x));
            const float error = noise * std::sqrt(12.0f) * (random_uniform(key, 0) - 0.5f);
            film.add(x, y, {Vec3f(value(x, y) + error), 1, static_cast<float>(x), 1});
        }
    }
    return film;
}

Image filled(const Film& film) {
    Image image = film.image();
    fill_coarse(film, image);
    return image;
}

template <class Value>
double rms_error(const Image& image, const Value& value) {
    double sum = 0;
    const auto red = image.channel("R");
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float d = red[image.index(x, y)] - value(x, y);
            sum += static_cast<double>(d * d);
        }
    }
    return std::sqrt(sum / (width * height));
}

TEST(CoarseFill, KeepsAConstant) {
    for (const int edge : {8, 4, 2}) {
        const Image image = filled(first_samples(edge, [](int, int) { return 3.0f; }));
        for (const float v : image.channel("R")) EXPECT_NEAR(v, 3, 1e-5);
        for (const float v : image.channel("A")) EXPECT_NEAR(v, 1, 1e-6);
    }
}

TEST(CoarseFill, LeavesACompletePictureAlone) {
    const Film film = first_samples(
        1, [](int x, int y) { return static_cast<float>(x + 7 * y); }, 1);
    EXPECT_EQ(filled(film).planes[0].values, film.image().planes[0].values);
}

// The weights keep (C(16, 8) / 2^16)^2 = 0.0386 of the variance of independent samples, linear
// interpolation takes a little more away, the border a little less.
TEST(CoarseFill, AveragesNoise) {
    for (const int edge : {8, 4, 2}) {
        const auto flat = [](int, int) { return 3.0f; };
        const double left = rms_error(filled(first_samples(edge, flat, 1)), flat);
        EXPECT_LT(left, 1.3 * std::sqrt(0.0386));
        EXPECT_GT(left, 0.5 * std::sqrt(0.0386));
    }
}

// The finer the blocks, the nearer to what the picture is.
TEST(CoarseFill, ConvergesToThePicture) {
    const auto wave = [](int x, int y) {
        return 1 +
               std::sin(0.05f * static_cast<float>(x)) * std::cos(0.04f * static_cast<float>(y));
    };
    const double e8 = rms_error(filled(first_samples(8, wave)), wave),
                 e4 = rms_error(filled(first_samples(4, wave)), wave),
                 e2 = rms_error(filled(first_samples(2, wave)), wave);
    EXPECT_LT(e8, 0.3);
    EXPECT_LT(e4, 0.5 * e8);
    EXPECT_LT(e2, 0.5 * e4);
}

// Depth is one that was seen, never a mean over an edge.
TEST(CoarseFill, TakesDepthFromOneSample) {
    const Image image = filled(first_samples(8, [](int, int) { return 1.0f; }));
    const auto depth = image.channel("Z");
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float z = depth[image.index(x, y)];
            EXPECT_EQ(z, std::floor(z));
            EXPECT_LT(std::abs(z - static_cast<float>(x)), 8);
        }
    }
}

// Where four blocks of the next size are complete, the picture is made of that.
TEST(CoarseFill, UsesFinerSamplesWhereTheyAre) {
    const auto stripes = [](int x, int) { return static_cast<float>(x % 2); };
    Film film = first_samples(8, stripes);
    for (int y = 16; y < 32; ++y) {
        for (int x = 16; x < 32; ++x) {
            if (film.samples(x, y) == 0) film.add(x, y, {Vec3f(stripes(x, y)), 1, 1, 1});
        }
    }
    const Image image = filled(film);
    const auto red = image.channel("R");
    for (int y = 16; y < 32; ++y) {
        for (int x = 16; x < 32; ++x) EXPECT_EQ(red[image.index(x, y)], stripes(x, y));
    }
    EXPECT_GT(red[image.index(60, 40)], 0);
    EXPECT_LT(red[image.index(60, 40)], 1);
}

}  // namespace
}  // namespace gischt
