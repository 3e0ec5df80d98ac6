// SPDX-License-Identifier: Apache-2.0
#include "render/aov.h"

#include <gtest/gtest.h>

#include <array>

#include "base/error.h"
#include "optics/local_lights.h"
#include "render/method.h"

namespace gischt {
namespace {

constexpr std::array some{Aov::Direct, Aov::Normal, Aov::Motion};

AovLayout layout_of(std::vector<std::string> names, const View& view = {}, bool groups = false) {
    RenderSettings settings;
    settings.aovs = std::move(names);
    return aov_layout(view, settings, {.method = "test", .aovs = some, .light_groups = groups});
}

TEST(AovLayout, PutsTheLayersIntoTheOrderOfTheTable) {
    const AovLayout layout = layout_of({"motion", "samples", "direct"});
    EXPECT_EQ(layout.channels, (std::vector<std::string>{"direct.R", "direct.G", "direct.B",
                                                         "motion.X", "motion.Y"}));
    EXPECT_EQ(layout.direct, 0);
    EXPECT_EQ(layout.motion, 3);
    EXPECT_EQ(layout.normal, -1);
    EXPECT_TRUE(layout.samples);
    EXPECT_FALSE(layout.variance);
    std::vector<float> extra(5);
    AovLayout::add(extra, layout.motion, Vec2f{1, 2});
    AovLayout::add(extra, layout.normal, Vec3f(9));
    EXPECT_EQ(extra, (std::vector<float>{0, 0, 0, 1, 2}));
}

TEST(AovLayout, AllIsWhatTheMethodCan) {
    const AovLayout layout = layout_of({"all"});
    EXPECT_EQ(layout.channels.size(), 8u);
    EXPECT_TRUE(layout.variance && layout.samples);
    EXPECT_EQ(layout.transmittance, -1);
}

TEST(AovLayout, NamesWhatIsNotThere) {
    EXPECT_THROW(layout_of({"transmittance"}), Error);
    try {
        layout_of({"motoin"});
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.hint(), "did you mean 'motion'?");
    }
}

TEST(AovLayout, GivesEachGroupOfLightsALayer) {
    View view;
    for (const char* group : {"key", "", "fill", "key"}) {
        PointLight light({0, 0, 1}, Vec3f(1));
        light.group = group;
        view.lights.push_back(std::make_shared<PointLight>(light));
    }
    const AovLayout layout = layout_of({"direct"}, view, true);
    EXPECT_EQ(layout.channels[3], "light_fill.R");
    EXPECT_EQ(layout.channels[6], "light_key.R");
    EXPECT_EQ(layout.light_group, (std::vector<int>{6, -1, 3, 6}));
    EXPECT_EQ(layout_of({}, view, false).channels.size(), 0u);
}

}  // namespace
}  // namespace gischt
