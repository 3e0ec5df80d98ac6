// SPDX-License-Identifier: Apache-2.0
#include "image/denoise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/compare.h"

namespace gischt {
namespace {

constexpr int edge = 96;

// Truths: 0 flat, 1 a gradient, 2 an edge with a thin bar, 3 stripes of 6 pixels.
float truth_at(int kind, int x, int y) {
    if (kind == 0) return 0.5f;
    if (kind == 1) return 0.2f + 0.01f * static_cast<float>(x);
    if (kind == 2) return x + y / 4 > 60 ? 4.0f : x == 30 ? 3.0f : 0.3f;
    return 1 + 0.6f * std::sin(static_cast<float>(x + y) * 1.047f);
}

Image truth(int kind) {
    Image image = Image::rgb(edge, edge);
    image.add_channel("variance.Y");
    const float tint[] = {1.1f, 1.0f, 0.7f};
    for (int y = 0; y < edge; ++y) {
        for (int x = 0; x < edge; ++x) {
            for (std::size_t c = 0; c < 3; ++c)
                image.planes[c].values[image.index(x, y)] = tint[c] * truth_at(kind, x, y);
        }
    }
    return image;
}

// With grey normal noise whose variance is 0.05 of the luminance.
Image with_noise(Image image, std::uint64_t seed) {
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const std::uint64_t key = random_key(seed, i);
        const float n = std::sqrt(-2 * std::log(1 - random_uniform(key, 0))) *
                        std::cos(6.2831853f * random_uniform(key, 1));
        const float y = 0.2126f * image.planes[0].values[i] + 0.7152f * image.planes[1].values[i] +
                        0.0722f * image.planes[2].values[i];
        const float v = 0.05f * y;
        for (std::size_t c = 0; c < 3; ++c) image.planes[c].values[i] *= 1 + n * std::sqrt(v) / y;
        image.planes[3].values[i] = v;
    }
    return image;
}

Image denoised(Image image) {
    Job job;
    denoise(image, job);
    return image;
}

TEST(Denoise, ErrorFallsAndFlickerWithIt) {
    const double most[] = {0.03, 0.1, 0.5, 1.02};
    for (int kind = 0; kind < 4; ++kind) {
        const Image exact = truth(kind), a = with_noise(exact, 1), b = with_noise(exact, 2);
        const Image fa = denoised(a), fb = denoised(b);
        const double gain = compare(fa, exact).mse / compare(a, exact).mse;
        const double flicker = compare(fa, fb).mse / compare(a, b).mse;
        RecordProperty("gain" + std::to_string(kind), std::to_string(gain));
        EXPECT_LT(gain, most[kind]) << kind;
        EXPECT_LT(flicker, std::max(gain * 1.1, 0.01)) << kind;
    }
}

TEST(Denoise, KeepsTheMeanAndTheNoisyPicture) {
    const Image noisy = with_noise(truth(2), 3), out = denoised(noisy);
    EXPECT_NEAR(compare(out, noisy).ratio, 1, 1e-5);
    EXPECT_EQ(out.find("noisy.G")->values, noisy.find("G")->values);
    EXPECT_EQ(out.find("variance.Y")->values, noisy.find("variance.Y")->values);
    EXPECT_EQ(out.metadata.get("denoised"), "true");
}

TEST(Denoise, LeavesAPictureWithoutNoise) {
    const Image exact = truth(2), out = denoised(exact);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(out.planes[c].values, exact.planes[c].values);
}

TEST(Denoise, SameBitsOnAnyNumberOfThreads) {
    const Image noisy = with_noise(truth(1), 4), many = denoised(noisy);
    const ThreadLimit one(1);
    EXPECT_EQ(denoised(noisy), many);
}

TEST(Denoise, StopsWhenAsked) {
    Image image = with_noise(truth(1), 4);
    const Image before = image;
    Job job;
    job.cancel();
    EXPECT_THROW(denoise(image, job), Error);
    EXPECT_EQ(image, before);
}

TEST(Denoise, SaysWhatIsMissing) {
    Image image = Image::rgb(4, 4);
    Job job;
    EXPECT_THROW(denoise(image, job), Error);
    image.add_channel("variance.Y")[3] = std::nanf("");
    EXPECT_THROW(denoise(image, job), Error);
    image.channel("variance.Y")[3] = -1;
    EXPECT_THROW(denoise(image, job), Error);
    image.channel("variance.Y")[3] = 1;
    denoise(image, job);
    EXPECT_THROW(denoise(image, job), Error);
}

}  // namespace
}  // namespace gischt
