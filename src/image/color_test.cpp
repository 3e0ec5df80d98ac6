// SPDX-License-Identifier: Apache-2.0
#include "image/color.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/colormap.h"
#include "image/primaries.h"
#include "image/tone_curve.h"

namespace gischt {
namespace {

TEST(Color, SrgbHasItsPublishedValuesAndAnInverse) {
    EXPECT_NEAR(srgb_encode(0.5f), 0.735357f, 1e-5);
    EXPECT_NEAR(srgb_decode(0.5f), 0.214041f, 1e-6);
    EXPECT_EQ(srgb_encode(0), 0);
    EXPECT_NEAR(srgb_encode(1), 1, 1e-6);
    for (int i = -100; i <= 300; ++i) {
        const float v = static_cast<float>(i) / 100;
        EXPECT_NEAR(srgb_decode(srgb_encode(v)), v, 1e-5f);
    }
}

TEST(Color, MatricesFollowFromThePrimaries) {
    const Transform m = rgb_to_xyz(rec709_primaries);
    for (const Vec3d& c : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        EXPECT_LT(length(m.vector(c) - rec709_to_xyz(c)), 1e-12);
        EXPECT_LT(length(xyz_to_rec709(rec709_to_xyz(c)) - c), 1e-12);
        // The luminance weights of the standard are the middle row, rounded to 4 digits.
        EXPECT_NEAR(luminance(c), rec709_to_xyz(c).y, 5e-5);
    }
}

// ACES AP1 with its white to Rec.709: the first row that the Academy publishes (S-2014-003).
TEST(Color, ConvertsPrimariesAsTheAcademyDoes) {
    const Primaries ap1{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
    const Transform m = convert_primaries(ap1, rec709_primaries);
    EXPECT_NEAR(m.column[0].x, 1.70505, 1e-4);
    EXPECT_NEAR(m.column[1].x, -0.62179, 1e-4);
    EXPECT_NEAR(m.column[2].x, -0.08326, 1e-4);
    EXPECT_LT(length(m.vector(Vec3d(1)) - Vec3d(1)), 1e-9);
}

TEST(ToneCurve, LinearClips) {
    const ToneCurve tone(ToneKind::Linear);
    EXPECT_EQ(tone({0.25f, -1, 7}), Vec3f(0.25f, 0, 1));
}

TEST(ToneCurve, FilmicMapsBlackGreyAndWhite) {
    const ToneCurve tone(ToneKind::Filmic);
    EXPECT_EQ(tone(Vec3f(0)), Vec3f(0));
    EXPECT_NEAR(tone(Vec3f(0.18f)).y, 0.18, 1e-4);
    EXPECT_NEAR(tone(Vec3f(16)).y, 1, 1e-4);
    EXPECT_NEAR(tone(Vec3f(std::numeric_limits<float>::infinity())).x, 1, 1e-4);
    EXPECT_EQ(tone(Vec3f(std::numeric_limits<float>::quiet_NaN())), Vec3f(0));
}

TEST(ToneCurve, IsMonotoneInBoundsAndKeepsGreysGrey) {
    for (const ToneKind kind : {ToneKind::Linear, ToneKind::Filmic}) {
        const ToneCurve tone(kind);
        for (const Vec3f& color : {Vec3f(1), Vec3f{1, 0.3f, 0.05f}, Vec3f{0.1f, 0.3f, 1},
                                   Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}}) {
            float last = 0;
            for (double ev = -14; ev < 14; ev += 0.125) {
                const Vec3f c = tone(exposure_factor(ev) * color);
                EXPECT_GE(min_component(c), 0);
                EXPECT_LE(max_component(c), 1);
                EXPECT_GE(luminance(c), last - 1e-6f);
                last = luminance(c);
                if (color == Vec3f(1)) {
                    EXPECT_LT(max_component(c) - min_component(c), 1e-6f);
                }
            }
        }
    }
}

TEST(ToneCurve, BrightColorsTurnWhite) {
    const ToneCurve tone(ToneKind::Filmic);
    for (const Vec3f& color : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}}) {
        EXPECT_LT(min_component(tone(0.1f * color)), 0.02f);
        EXPECT_GT(min_component(tone(2000.0f * color)), 0.9f);
    }
}

TEST(ToneCurve, KnowsItsNames) {
    for (const auto& name : tone_names()) EXPECT_EQ(tone_name(tone_kind(name)), name);
    EXPECT_THROW(tone_kind("filmc"), Error);
}

int code(float linear) {
    return static_cast<int>(std::lround(255 * srgb_encode(linear)));
}

TEST(Colormap, HasThePublishedColorsAndClamps) {
    const Vec3f low = colormap(ColormapKind::Viridis, -1),
                high = colormap(ColormapKind::Viridis, 2);
    EXPECT_EQ(code(low.x), 0x44);
    EXPECT_EQ(code(low.z), 0x54);
    EXPECT_EQ(code(high.x), 0xfd);
    EXPECT_EQ(code(high.y), 0xe7);
    const Vec3f middle = colormap(ColormapKind::Coolwarm, 0.5f);
    EXPECT_EQ(code(middle.x), 221);
    EXPECT_EQ(code(middle.z), 221);
    EXPECT_EQ(colormap(ColormapKind::Grey, std::nanf("")), Vec3f(1, 0, 1));
    for (const auto& name : colormap_names()) colormap(colormap_kind(name), 0.3f);
    EXPECT_THROW(colormap_kind("jet"), Error);
}

// Even steps: the luminance of the one-sided maps grows from end to end.
TEST(Colormap, OneSidedMapsGrowLighter) {
    for (const ColormapKind kind :
         {ColormapKind::Viridis, ColormapKind::Magma, ColormapKind::Inferno, ColormapKind::Grey}) {
        float last = -1;
        for (int i = 0; i <= 64; ++i) {
            const float y = luminance(colormap(kind, static_cast<float>(i) / 64));
            EXPECT_GT(y, last);
            last = y;
        }
    }
}

}  // namespace
}  // namespace gischt
