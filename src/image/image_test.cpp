// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/resize.h"

namespace gischt {
namespace {

TEST(Image, FindsChannelsAndNamesThemWhenOneIsMissing) {
    Image image = Image::rgba(3, 2);
    image.add_channel("direct.R")[image.index(2, 1)] = 5;
    EXPECT_EQ(image.channel("direct.R").back(), 5);
    EXPECT_EQ(image.add_channel("direct.R").back(), 5);
    try {
        image.channel("Z");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.hint(), "channels: R, G, B, A, direct.R");
    }
}

TEST(Image, OneGreyChannelIsAllThreeColors) {
    Image image(2, 2, {});
    image.add_channel("Y")[1] = 3;
    for (const auto& plane : std::as_const(image).color()) EXPECT_EQ(plane[1], 3);
    EXPECT_THROW(std::as_const(image).color("direct"), Error);
}

TEST(Image, RefusesSizesThatNoImageHas) {
    EXPECT_THROW(Image::rgb(0, 5), Error);
    EXPECT_THROW(Image::rgb(5, 65537), Error);
}

TEST(Metadata, KeepsOrderAndReplaces) {
    Metadata m;
    m.set("b", "1");
    m.set("a", "2");
    m.set("b", "3");
    EXPECT_EQ(m.entries.front(), std::make_pair(std::string("b"), std::string("3")));
    EXPECT_EQ(m.get("a"), "2");
    EXPECT_EQ(m.get("c"), "");
}

TEST(Resize, KeepsTheMeanAndHalvesExactly) {
    Image image(6, 4, {});
    const auto v = image.add_channel("Y");
    double mean = 0;
    for (std::size_t i = 0; i < v.size(); ++i) mean += v[i] = static_cast<float>(i * i % 17);
    mean /= static_cast<double>(v.size());
    const auto half = resize(image, 3, 2).planes[0].values;
    EXPECT_EQ(half[0], (v[0] + v[1] + v[6] + v[7]) / 4);
    for (const auto& [w, h] : {std::pair(4, 3), std::pair(5, 1), std::pair(13, 9)}) {
        double sum = 0;
        const Image other = resize(image, w, h);
        for (const float x : other.planes[0].values) sum += x;
        EXPECT_NEAR(sum / (w * h), mean, 1e-5);
    }
    EXPECT_EQ(resize(image, 6, 4).planes, image.planes);
    EXPECT_EQ(fit(image, 3, 100).height, 2);
}

TEST(Paste, ClipsAtTheBorders) {
    Image sheet = Image::rgb(4, 4), part = Image::rgb(3, 3);
    for (float& v : part.channel("R")) v = 1;
    paste(sheet, part, -2, 2);
    paste(sheet, part, 9, 9);
    double sum = 0;
    for (const float v : sheet.channel("R")) sum += v;
    EXPECT_EQ(sum, 2);
    EXPECT_EQ(sheet.channel("R")[sheet.index(0, 3)], 1);
}

}  // namespace
}  // namespace gischt
