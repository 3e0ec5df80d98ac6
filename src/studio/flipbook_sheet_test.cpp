// SPDX-License-Identifier: Apache-2.0
#include "studio/flipbook_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.h"

namespace gischt {
namespace {

Image filled(int width, int height, std::initializer_list<std::pair<const char*, float>> channels) {
    Image image(width, height, {});
    for (const auto& [name, value] : channels) {
        for (float& v : image.add_channel(name)) v = value;
    }
    return image;
}

TEST(SheetLayout, GoesRowByRowFromTheTopLeft) {
    const SheetLayout layout{3, 2, 4, 5};
    EXPECT_EQ(layout.corner(0), (Vec2i{0, 0}));
    EXPECT_EQ(layout.corner(2), (Vec2i{8, 0}));
    EXPECT_EQ(layout.corner(3), (Vec2i{0, 5}));
    EXPECT_EQ(layout.corner(5), (Vec2i{8, 5}));

    Image sheet = filled(12, 10, {{"R", 0}});
    for (int cell = 0; cell < 6; ++cell) {
        Image part = filled(4, 5, {{"R", 0}, {"G", 9}});
        part.channel("R")[part.index(1, 2)] = static_cast<float>(cell + 1);
        add_cell(sheet, layout, cell, part, 2);
    }
    const auto red = sheet.channel("R");
    EXPECT_FALSE(sheet.has("G"));
    for (int cell = 0; cell < 6; ++cell) {
        EXPECT_EQ(red[sheet.index(cell % 3 * 4 + 1, cell / 3 * 5 + 2)], 2.0f * float(cell + 1));
    }
    EXPECT_EQ(std::count(red.begin(), red.end(), 0.0f), 120 - 6);
}

TEST(SheetLayout, IsNearlySquareAndHoldsAllCells) {
    for (int cells = 1; cells <= 200; ++cells) {
        for (const Vec2i cell : {Vec2i{64, 64}, Vec2i{64, 32}, Vec2i{16, 48}}) {
            const SheetLayout l = square_sheet(cells, cell);
            EXPECT_GE(l.cells(), cells);
            EXPECT_LT(l.cells() - l.columns, cells) << "no empty row";
            // Never more than a column wider than high.
            EXPECT_LT(l.width() - l.cell_width, std::sqrt(1.0 * cells * cell.x * cell.y) + 1e-9);
        }
    }
    EXPECT_EQ(square_sheet(64, {128, 128}).columns, 8);
}

TEST(SheetLayout, RefusesWhatNoTextureCanBe) {
    EXPECT_NO_THROW(check_sheet({128, 128, 128, 128}, 16384));
    EXPECT_THROW(check_sheet({128, 128, 128, 128}, 16385), Error);
    EXPECT_THROW(check_sheet({129, 1, 128, 128}, 1), Error);
    EXPECT_THROW(check_sheet({1, 129, 128, 128}, 1), Error);
    EXPECT_THROW(check_sheet({0, 1, 128, 128}, 0), Error);
    EXPECT_THROW(check_sheet({1, 1, 128, -1}, 1), Error);
    EXPECT_THROW(check_sheet({2147483647, 2, 2147483647, 1}, 1), Error);
    EXPECT_THROW(square_sheet(1, {0, 128}), Error);
    EXPECT_THROW(square_sheet(20000, {128, 128}), Error);
}

TEST(CellShare, GivesEveryCellTheWeightOne) {
    for (const auto& [frames, loop] : {std::pair{1, 0}, {7, 0}, {7, 1}, {7, 3}, {8, 4}, {64, 16}}) {
        std::vector<double> sum(static_cast<std::size_t>(frames - loop));
        for (int f = 0; f < frames; ++f) {
            const CellShare share = cell_share(f, frames, loop);
            sum.at(static_cast<std::size_t>(share.cell)) += static_cast<double>(share.weight);
        }
        for (const double s : sum) EXPECT_NEAR(s, 1, 1e-6) << frames << " " << loop;
    }
    EXPECT_NO_THROW(check_loop(8, 4));
    EXPECT_THROW(check_loop(8, 5), Error);
    EXPECT_THROW(check_loop(8, -1), Error);
}

// Frames of the values 0, 1, 2 ... are the hardest to loop. With M cells and a fade over N, each
// step of the fade, the one into it and the one from the last cell to the first is 1 - M / (N + 1).
TEST(CellShare, ClosesTheLoopInEqualSteps) {
    constexpr int frames = 20, loop = 6, cells = frames - loop;
    std::vector<double> value(cells);
    for (int f = 0; f < frames; ++f) {
        const CellShare share = cell_share(f, frames, loop);
        value[static_cast<std::size_t>(share.cell)] += static_cast<double>(share.weight) * f;
    }
    EXPECT_NEAR(value[0], loop, 1e-6);
    for (int c = 0; c < cells; ++c) {
        const double step =
            value[static_cast<std::size_t>((c + 1) % cells)] - value[static_cast<std::size_t>(c)];
        const double truth = c < cells - loop - 1 ? 1 : 1 - double(cells) / (loop + 1);
        EXPECT_NEAR(step, truth, 1e-5) << c;
    }
}

TEST(StraightAlpha, DividesByTheCoverageAndPadsWithinTheCell) {
    const SheetLayout layout{2, 1, 4, 4};
    Image sheet = filled(8, 4, {{"R", 0}, {"A", 0}});
    sheet.channel("R")[sheet.index(1, 1)] = 0.1f;
    sheet.channel("A")[sheet.index(1, 1)] = 0.25f;
    const auto coverage = sheet.channel("A");
    const std::vector<float> before(coverage.begin(), coverage.end());
    make_straight(sheet, layout);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            EXPECT_NEAR(sheet.channel("R")[sheet.index(x, y)], x < 4 ? 0.4f : 0, 1e-6f)
                << x << " " << y;
        }
    }
    EXPECT_TRUE(std::equal(before.begin(), before.end(), sheet.channel("A").begin()));
}

// Between a texel of 1 and one of 3 the padding is their mean.
TEST(StraightAlpha, PaddingIsTheMeanOfWhatIsNear) {
    Image sheet = filled(3, 1, {{"R", 0}, {"A", 0}});
    sheet.channel("R")[0] = 0.5f;
    sheet.channel("A")[0] = 0.5f;
    sheet.channel("R")[2] = 3;
    sheet.channel("A")[2] = 1;
    make_straight(sheet, {1, 1, 3, 1});
    EXPECT_FLOAT_EQ(sheet.channel("R")[1], 2);
}

TEST(StraightAlpha, AFlameGetsTheCoverageThatCarriesIt) {
    Image sheet = filled(1, 1, {{"R", 0.6f}, {"G", 0.2f}, {"B", 0.1f}, {"A", 0.1f}});
    const Image glow = filled(1, 1, {{"R", 0.6f}, {"G", 0.2f}, {"B", 0.1f}});
    carry_glow(sheet, glow, 0.5f);
    EXPECT_FLOAT_EQ(sheet.channel("A")[0], 0.3f);
    carry_glow(sheet, glow, 100);
    EXPECT_FLOAT_EQ(sheet.channel("A")[0], 1);
}

TEST(LightMaps, ArePackedAsUnityReadsThem) {
    const Image light = filled(2, 2,
                               {{"right", 0.1f},
                                {"top", 0.2f},
                                {"back", 0.3f},
                                {"left", 0.4f},
                                {"bottom", 0.5f},
                                {"front", 0.6f},
                                {"A", 0.7f}});
    const Image glow = filled(2, 2, {{"R", 3}, {"G", 3}, {"B", 3}});
    const auto expect = [](const Image& map, const char* channel, float value) {
        for (const float v : map.channel(channel)) EXPECT_NEAR(v, value, 1e-6f) << channel;
    };
    const Image a = pack_light_a(light), b = pack_light_b(light, &glow, 4);
    expect(a, "R", 0.1f);
    expect(a, "G", 0.2f);
    expect(a, "B", 0.3f);
    expect(a, "A", 0.7f);
    expect(b, "R", 0.4f);
    expect(b, "G", 0.5f);
    expect(b, "B", 0.6f);
    expect(b, "A", 0.75f);
    expect(pack_light_b(light, nullptr, 1), "A", 0);
}

}  // namespace
}  // namespace gischt
