// SPDX-License-Identifier: Apache-2.0
#include "schema/override.h"

#include <gtest/gtest.h>

#include "schema/test_scene.h"

namespace gischt::test {
namespace {

const std::string one_fluid = "[[fluid]]\nname = \"lava\"\n[[light]]\nname = \"key\"\n";
const std::string two_fluids =
    one_fluid + "[[fluid]]\nname = \"smoke\"\n[[light]]\nname = \"fill\"\n";

Value with(const std::string& text, const std::string& assignment) {
    Value scene = parse_toml(text, "plume.toml");
    apply_override(scene, assignment, addressing_of(scene_table(), {"fluid"}));
    return scene;
}

std::string error_of(const std::string& text, const std::string& assignment) {
    return message_of([&] { with(text, assignment); });
}

const Value& fluid(const Value& scene, std::size_t i) {
    return scene.find("fluid")->array().at(i);
}

TEST(Override, AddressesMembersByNameOrIndex) {
    const Value by_name = with(two_fluids, "fluid.smoke.domain.resolution=7");
    EXPECT_EQ(fluid(by_name, 1).find("domain")->find("resolution")->integer(), 7);
    EXPECT_EQ(fluid(by_name, 0).find("domain"), nullptr);
    EXPECT_EQ(with(two_fluids, "fluid.1.domain.resolution=7"), by_name);
    EXPECT_EQ(with(two_fluids, "smoke.domain.resolution = 7"), by_name);
    EXPECT_EQ(with(two_fluids, "light.fill.radiance=[1, 2, 3]")
                  .find("light")
                  ->array()
                  .at(1)
                  .find("radiance")
                  ->array()
                  .size(),
              3u);
}

TEST(Override, NeedsNoNameWhereThereIsOnlyOne) {
    const Value expected = with(one_fluid, "fluid.lava.medium.g=0.5");
    for (const char* text : {"fluid.medium.g=0.5", "medium.g=0.5", "lava.medium.g=0.5"}) {
        EXPECT_EQ(with(one_fluid, text), expected) << text;
    }
    EXPECT_EQ(with("[fluid]\nname = \"lava\"", "lava.file=a").find("fluid")->find("file")->string(),
              "a");
    EXPECT_EQ(with("[fluid]\n", "fluid.0.file=a"), with("[fluid]\n", "file=a"));
    EXPECT_EQ(with("[fluid]\n", "file=a").find("fluid")->find("file")->string(), "a");
}

TEST(Override, MakesMissingTablesAndPrefersRoots) {
    const Value v = with("", "camera.position=[0, 1, 2]");
    EXPECT_EQ(v.find("camera")->find("position")->array().at(2).integer(), 2);
    EXPECT_EQ(with("", "seed=4").find("seed")->integer(), 4);
}

TEST(Override, ReachesIntoVectorsAndReplacesMembers) {
    const std::string text = "[camera]\nposition = [1, 2, 3]\n" + one_fluid;
    EXPECT_EQ(
        with(text, "camera.position.1=9").find("camera")->find("position")->array()[1].integer(),
        9);
    EXPECT_EQ(
        with(text, "light.key={ type = \"sun\" }").find("light")->array()[0].find("type")->string(),
        "sun");
    EXPECT_EQ(error_of(text, "camera.position.x=9"),
              "--set camera.position.x=9: 'camera.position' is a list, and 'x' no index of it; "
              "valid: 0 to 2");
}

TEST(Override, ValuesAreTomlOrBareWords) {
    const auto value = [](const std::string& text) {
        return *with("", "seed=" + text).find("seed");
    };
    EXPECT_EQ(value("5"), Value(5));
    EXPECT_EQ(value(" 5e0 "), Value(5.0));
    EXPECT_EQ(value("true"), Value(true));
    EXPECT_EQ(value("\"a b\""), Value("a b"));
    EXPECT_EQ(value("a b"), Value("a b"));
    EXPECT_EQ(value("/tmp/x_####.vdb"), Value("/tmp/x_####.vdb"));
    EXPECT_EQ(value("2020-01-01"), Value("2020-01-01"));
    EXPECT_EQ(value("a=b"), Value("a=b"));
    EXPECT_EQ(value(""), Value(""));
    EXPECT_EQ(value("5\nx = 3"), Value("5\nx = 3"));
    EXPECT_EQ(value("[1, [2]]"), Value(Value::Array{Value(1), Value(Value::Array{Value(2)})}));
    EXPECT_EQ(value("{ t = [0, 1], v = [0, 5] }").find("v")->array()[1], Value(5));
}

TEST(Override, ErrorsNameWhatThereIs) {
    EXPECT_EQ(error_of(two_fluids, "domain.resolution=1"),
              "--set domain.resolution=1: 'fluid' has 2 members, and 'domain' is the name of none; "
              "write fluid.NAME.domain.resolution, where NAME is one of lava, smoke");
    EXPECT_EQ(
        error_of(two_fluids, "light.kee.radiance=1"),
        "--set light.kee.radiance=1: 'light' has 2 members, and 'kee' is the name of none; did "
        "you mean 'key'?");
    EXPECT_EQ(error_of(two_fluids, "light.2.radiance=1"),
              "--set light.2.radiance=1: 'light' has no member 2; valid: 0 to 1");
    EXPECT_EQ(error_of("", "medium.g=1"),
              "--set medium.g=1: 'medium' belongs to a fluid, and the scene has none");
    EXPECT_EQ(error_of(one_fluid, "medum.g=1"),
              "--set medum.g=1: unknown key 'medum'; did you mean 'medium'?");
    EXPECT_EQ(error_of("seed = 5", "seed.x=1"),
              "--set seed.x=1: 'seed' is a whole number and has no 'x'");
    EXPECT_EQ(error_of("", "seed"), "--set seed: no '=' in an override; write a.b.c=VALUE");
    EXPECT_EQ(error_of("", "a..b=1"), "--set a..b=1: an empty word in the path; write a.b.c=VALUE");
    EXPECT_NE(error_of("", "seed=[1,").find("--set seed=[1,: "), std::string::npos);
}

TEST(Override, TheSameChecksHoldAsForTheFile) {
    const auto checked = [](const std::string& assignment) {
        return message_of([&] { read(with("[fluid]", assignment), scene_table(), ""); });
    };
    EXPECT_EQ(checked("domain.resolution=abc"),
              "--set domain.resolution=abc: 'resolution' in [fluid.domain] must be a whole number, "
              "not a string");
    EXPECT_EQ(checked("domain.size=[1, 0, 1]"),
              "--set domain.size=[1, 0, 1]: 'size' in [fluid.domain] must be above 0 m, not 0");
    EXPECT_EQ(checked("domain.reslution=1"),
              "--set domain.reslution=1: unknown key 'reslution' in [fluid.domain]; did you mean "
              "'resolution'?");
}

}  // namespace
}  // namespace gischt::test
