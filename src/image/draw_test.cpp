// SPDX-License-Identifier: Apache-2.0
#include "image/draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "image/colormap.h"
#include "image/font.h"

namespace gischt {
namespace {

double sum(const Image& image, const char* channel) {
    double s = 0;
    for (const float v : image.channel(channel)) s += v;
    return s;
}

TEST(Font, GlyphsDifferAndFitFiveColumns) {
    std::set<std::array<std::uint8_t, 7>> seen;
    for (char c = ' '; c <= '~'; ++c) {
        seen.insert(glyph(c));
        for (const auto row : glyph(c)) EXPECT_LT(row, 32);
    }
    EXPECT_EQ(seen.size(), 95u);
    EXPECT_EQ(glyph('\xe4'), glyph('\x01'));
}

TEST(DrawText, CoversTheDotsOfItsGlyphsAndItsSize) {
    Image image = Image::rgba(20, 20);
    draw_text(image, {2, 3}, "T", {1, 0.5f, 0});
    EXPECT_EQ(sum(image, "R"), 5 + 6);
    EXPECT_EQ(sum(image, "A"), 5 + 6);
    EXPECT_EQ(image.channel("G")[image.index(4, 9)], 0.5f);
    EXPECT_EQ(text_size("ab\nc", 2), (Vec2i{22, 30}));
    EXPECT_EQ(text_size(""), (Vec2i{0, 0}));
}

TEST(DrawLine, CoversLengthTimesWidthAnywhere) {
    for (const Vec2f to : {Vec2f{40, 10}, Vec2f{10, 40}, Vec2f{33, 41}}) {
        Image image = Image::rgb(50, 50);
        draw_line(image, {10, 10}, to, Vec3f(1), 3);
        const double length = std::hypot(to.x - 10, to.y - 10);
        EXPECT_NEAR(sum(image, "R"), 3 * length + 7.07, 1.5);  // and two half circles
    }
}

TEST(Draw, ClipsWhatLiesOutside) {
    Image image = Image::rgb(8, 8);
    draw_text(image, {-3, -3}, "gischt", Vec3f(1), 3);
    draw_line(image, {-1e9f, 4}, {1e9f, 4}, Vec3f(1));
    draw_arrow(image, {4, 4}, {4000, -4000}, Vec3f(1), 2);
    draw_arrow(image, {4, 4}, {4, 4}, Vec3f(1));
    draw_arrow(image, {4, 4}, {std::numeric_limits<float>::infinity(), 0}, Vec3f(1));
    fill_rectangle(image, {-5, 6}, {100, 100}, Vec3f(1));
    for (const float v : image.channel("R")) EXPECT_LE(v, 1);
}

TEST(DrawArrow, PointsAtItsEnd) {
    Image image = Image::rgb(40, 20);
    draw_arrow(image, {5, 10}, {35, 10}, Vec3f(1), 1);
    auto column = [&](int x) {
        double s = 0;
        for (int y = 0; y < 20; ++y) s += image.channel("R")[image.index(x, y)];
        return s;
    };
    EXPECT_NEAR(column(15), 1, 0.1);
    EXPECT_GT(column(29), 3);
    EXPECT_LT(column(34), 1.5);
    EXPECT_EQ(column(37), 0);
}

TEST(DrawColormap, GrowsUpwards) {
    Image image = Image::rgb(4, 10);
    draw_colormap(image, {0, 0}, {4, 10}, ColormapKind::Grey);
    EXPECT_EQ(image.channel("R")[image.index(0, 9)], 0);
    EXPECT_NEAR(image.channel("R")[0], 1, 1e-6);
}

}  // namespace
}  // namespace gischt
