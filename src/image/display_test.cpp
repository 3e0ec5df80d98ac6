// SPDX-License-Identifier: Apache-2.0
#include "image/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/parallel.h"
#include "image/color.h"
#include "image/dither.h"

namespace gischt {
namespace {

TEST(Dither, EveryThresholdOccursOnce) {
    std::set<float> seen;
    for (int y = 0; y < dither_size; ++y) {
        for (int x = 0; x < dither_size; ++x) seen.insert(dither_threshold(x, y, 2));
    }
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(dither_size * dither_size));
    EXPECT_GT(*seen.begin(), 0);
    EXPECT_LT(*seen.rbegin(), 1);
    EXPECT_EQ(dither_threshold(3, 5, 0), dither_threshold(3 + dither_size, 5 - dither_size, 0));
}

TEST(Dither, KeepsTheMeanAndWholeNumbers) {
    for (const float code : {0.0f, 0.3f, 7.0f, 99.25f, 254.5f, 255.0f}) {
        double sum = 0;
        for (int y = 0; y < dither_size; ++y) {
            for (int x = 0; x < dither_size; ++x) {
                sum += dither(code, 255, dither_threshold(x, y, 0));
            }
        }
        EXPECT_NEAR(sum / (dither_size * dither_size), code, 2e-4);
    }
    EXPECT_EQ(dither(std::nanf(""), 255, 0.5f), 0);
    EXPECT_EQ(dither(1e9f, 255, 0.5f), 255);
}

// Blue: blurred over 4 x 4 pixels, the thresholds vary far less than white noise would: its
// standard deviation would be sqrt(1/12) / 4 = 0.072.
TEST(Dither, IsBlue) {
    double squares = 0;
    for (int y = 0; y < dither_size; ++y) {
        for (int x = 0; x < dither_size; ++x) {
            double mean = 0;
            for (int k = 0; k < 16; ++k) mean += dither_threshold(x + k % 4, y + k / 4, 0) / 16.0;
            squares += (mean - 0.5) * (mean - 0.5);
        }
    }
    EXPECT_LT(std::sqrt(squares / (dither_size * dither_size)), 0.03);
}

// A sky from code 100 to 102 over 400 pixels: the columns' means follow it, without bands.
TEST(Display, SmoothGradientsShowNoBands) {
    Image image = Image::rgb(400, 64);
    for (auto& plane : image.planes) {
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 400; ++x) {
                const float code = 100 + static_cast<float>(x) / 200;
                plane.values[image.index(x, y)] = srgb_decode(code / 255);
            }
        }
    }
    const auto bytes = to_rgb8(image, {.tone = ToneKind::Linear});
    for (int x = 0; x + 8 <= 400; x += 8) {
        double sum = 0;
        for (int y = 0; y < 64; ++y) {
            for (int k = 0; k < 8; ++k) sum += bytes[3 * image.index(x + k, y)];
        }
        EXPECT_NEAR(sum / 512, 100 + (x + 3.5) / 200, 0.05);
    }
}

TEST(Display, FlamesCarryTheirOwnCoverage) {
    Image image = Image::rgba(2, 1);
    image.channel("R")[0] = 0.5f;  // light without coverage
    image.channel("R")[1] = 0.2f;  // smoke: less light than coverage
    image.channel("A")[1] = 0.4f;
    const auto d = to_display(image, {.tone = ToneKind::Linear, .exposure = 0, .alpha = true}, 16);
    ASSERT_EQ(d.channels, 4);
    EXPECT_NEAR(d.codes[3] / 65535.0, 0.5, 1e-4);
    EXPECT_EQ(d.codes[0], 65535);
    EXPECT_NEAR(d.codes[7] / 65535.0, 0.4, 1e-4);
    EXPECT_NEAR(d.codes[4] / 65535.0, srgb_encode(0.5f), 1e-4);
}

TEST(Display, ExposureIsInStopsAndThreadsDoNotMatter) {
    Image image = Image::rgb(50, 50);
    for (auto& plane : image.planes) {
        for (std::size_t i = 0; i < plane.values.size(); ++i) {
            plane.values[i] = static_cast<float>(i) / 5000;
        }
    }
    auto develop = [&](int threads) {
        const ThreadLimit limit(threads);
        return to_rgb8(image, {.exposure = 1});
    };
    const auto brighter = develop(1);
    EXPECT_EQ(brighter, develop(2));
    for (auto& plane : image.planes) {
        for (float& v : plane.values) v *= 2;
    }
    EXPECT_EQ(to_rgb8(image, {}), brighter);
}

}  // namespace
}  // namespace gischt
