// SPDX-License-Identifier: Apache-2.0
#include "image/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace gischt {
namespace {

// Two pixels; B = (1, 1, 1), (2, 2, 2); A differs by 0.5 in the first red and by -1 in the last
// blue. By hand: mse = (0.25 + 1) / 6; mean(B) = 1.5, so 0.01 mean^2 = 0.0225.
TEST(Compare, AgreesWithNumbersByHand) {
    Image a = Image::rgb(2, 1), b = Image::rgb(2, 1);
    for (Image* image : {&a, &b}) {
        for (auto& plane : image->planes) plane.values = {1, 2};
    }
    a.channel("R")[0] = 1.5f;
    a.channel("B")[1] = 1;
    const Comparison r = compare(a, b);
    EXPECT_NEAR(r.mse, 1.25 / 6, 1e-12);
    EXPECT_NEAR(r.rmse, std::sqrt(1.25 / 6), 1e-12);
    EXPECT_NEAR(r.rel_mse, (0.25 / 1.0225 + 1 / 4.0225) / 6, 1e-12);
    EXPECT_NEAR(r.ratio, 8.5 / 9, 1e-12);
    EXPECT_NEAR(r.psnr, 10 * std::log10(4 / (1.25 / 6)), 1e-12);
    EXPECT_EQ(r.max_difference, 1);
    EXPECT_EQ(r.max_x, 1);
    EXPECT_EQ(r.max_channel, 'B');
}

TEST(Compare, EqualImagesAreEqual) {
    const Image a = Image::rgb(3, 3);
    const Comparison r = compare(a, a);
    EXPECT_EQ(r.rmse, 0);
    EXPECT_EQ(r.rel_mse, 0);
    EXPECT_EQ(r.ratio, 1);
    EXPECT_TRUE(std::isinf(r.psnr));
}

TEST(Compare, ANotANumberIsNeverClose) {
    Image a = Image::rgb(3, 3);
    a.channel("G")[4] = std::numeric_limits<float>::quiet_NaN();
    const Comparison r = compare(a, Image::rgb(3, 3));
    EXPECT_EQ(r.not_finite, 1u);
    EXPECT_TRUE(std::isinf(r.rmse));
    EXPECT_TRUE(std::isinf(r.max_difference));
    EXPECT_EQ(r.max_x, 1);
    EXPECT_EQ(r.max_y, 1);
}

TEST(Compare, RefusesDifferentSizes) {
    EXPECT_THROW(compare(Image::rgb(2, 2), Image::rgb(2, 3)), Error);
}

}  // namespace
}  // namespace gischt
