// SPDX-License-Identifier: Apache-2.0
#include "schema/table.h"

#include <gtest/gtest.h>

#include "schema/test_scene.h"

namespace gischt::test {
namespace {

TEST(Table, EmptyFileGivesTheDefaults) {
    EXPECT_EQ(read_scene(""), Scene{});
}

TEST(Table, ReadsEveryTypeOfParameter) {
    const Scene s = read_scene(
        "seed = 9007199254740993\n"
        "[camera]\nposition = [1, 2.5, 3]\nfov_degrees = 39\n"
        "[[fluid]]\nname = \"lava\"\nstart = 2\nfile = \"a.vdb\"\nsparse = false\n"
        "time_step = 0.5\nlevels = [1, 0.5]\nadvection = \"semi_lagrangian\"\n"
        "domain.resolution = 16\nmedium.g = 0.5\nmedium.extinction = 3\n"
        "[[light]]\ntype = \"sun\"\nname = \"key\"\nradiance = [1, 2, 3]\n"
        "[[light]]\ntype = \"point\"\nposition = [0, 0, 1]\n");
    EXPECT_EQ(s.seed, 9007199254740993);
    EXPECT_EQ(s.camera.position, Vec3d(1, 2.5, 3));
    const Fluid& f = s.fluids.at(0);
    EXPECT_EQ(f.name, "lava");
    EXPECT_EQ(f.start, 2);
    EXPECT_EQ(f.file, "a.vdb");
    EXPECT_FALSE(f.sparse);
    EXPECT_EQ(f.time_step, 0.5);
    EXPECT_EQ(f.levels, (std::vector<double>{1, 0.5}));
    EXPECT_EQ(f.advection, Advection::SemiLagrangian);
    EXPECT_EQ(f.domain.resolution, 16);
    EXPECT_EQ(f.domain.size, Domain{}.size);
    EXPECT_EQ(f.medium.value().extinction.at(7), Vec3d(3, 3, 3));
    EXPECT_EQ(std::get<Sun>(s.lights.at(0)).radiance, Vec3d(1, 2, 3));
    EXPECT_EQ(std::get<Point>(s.lights.at(1)).position, Vec3d(0, 0, 1));
}

TEST(Table, ReadingIntoAnObjectKeepsWhatIsNotWritten) {
    Domain d{7, {1, 2, 3}};
    read_into(d, parse_toml("resolution = 8", "f"), domain_table(), "domain");
    EXPECT_EQ(d, (Domain{8, {1, 2, 3}}));
}

TEST(Table, OneTableIsAListOfOne) {
    EXPECT_EQ(read_scene("[fluid]\nfile = \"x\"").fluids.at(0).file, "x");
}

TEST(Table, WhatIsWrittenReadsBackEqual) {
    Scene s;
    s.fluids.resize(2);
    s.fluids[0].name = "a \"b\" \\ \n \x01";
    s.fluids[0].buoyancy = Keyed<double>({0, 1.5}, {2, -3}, KeyInterpolation::Smooth);
    s.fluids[1].medium = Medium{Keyed<Vec3d>({0, 1}, {Vec3d(1, 2, 3), Vec3d(0.1)}), -0.7};
    s.fluids[1].time_step = 1e-7;
    s.fluids[1].levels = {1.0 / 3, -1e300};
    s.lights = {Sun{Vec3d(0.1), 1e21}, Point{{1, 2, 3}}};
    s.ambient = Sun{};
    const Value written = to_value(s, scene_table());
    EXPECT_EQ(read(written, scene_table()), s);
    EXPECT_EQ(read_scene(to_toml(written)), s);
    EXPECT_EQ(to_inline_toml(*written.find("camera")->find("fov_degrees")), "0.1");
}

TEST(Table, UnknownKeysNameTheNearestWordAtTheirPlace) {
    EXPECT_EQ(scene_error("[[fluid]]\nname = \"a\"\n  bouyancy = 1\n"),
              "plume.toml:3:3: unknown key 'bouyancy' in [fluid]; did you mean 'buoyancy'?");
    EXPECT_EQ(scene_error("fluud.x = 1"),
              "plume.toml:1:1: unknown key 'fluud' at the top level; did you mean 'fluid'?");
    EXPECT_EQ(scene_error("[fluid.domain]\nxyzzy = 1"),
              "plume.toml:2:1: unknown key 'xyzzy' in [fluid.domain]; valid: resolution, size");
}

TEST(Table, WrongTypesSayWhatIsExpectedAndWhere) {
    const auto fluid = [](const std::string& line) { return scene_error("[fluid]\n" + line); };
    const std::string at = "plume.toml:2:";
    EXPECT_EQ(fluid("domain.resolution = \"a\""),
              at + "21: 'resolution' in [fluid.domain] must be a whole number, not a string");
    EXPECT_EQ(fluid("domain.resolution = 2.5"),
              at + "21: 'resolution' in [fluid.domain] must be a whole number, not 2.5");
    EXPECT_EQ(fluid("domain = 5"), at + "10: 'fluid.domain' must be a table, not a whole number");
    EXPECT_EQ(fluid("domain.size = 5"),
              at + "15: 'size' in [fluid.domain] must be 3 numbers, not a whole number");
    EXPECT_EQ(fluid("domain.size = [1, 2]"),
              at + "15: 'size' in [fluid.domain] must be 3 numbers, not 2");
    EXPECT_EQ(fluid("domain.size = [1, true, 2]"),
              at + "19: 'size' in [fluid.domain] must be 3 numbers, not true or false");
    EXPECT_EQ(fluid("sparse = 1"),
              at + "10: 'sparse' in [fluid] must be true or false, not a whole number");
    EXPECT_EQ(fluid("file = 1"), at + "8: 'file' in [fluid] must be a string, not a whole number");
    EXPECT_EQ(fluid("levels = 1"),
              at + "10: 'levels' in [fluid] must be a list of numbers, not a whole number");
    EXPECT_EQ(fluid("time_step = { t = [0], v = [1] }"),
              at + "13: 'time_step' in [fluid] cannot be keyframed");
    EXPECT_EQ(fluid("buoyancy = \"x\""),
              at + "12: 'buoyancy' in [fluid] must be a number over time, not a string");
    EXPECT_EQ(fluid("medium.extinction = \"x\""),
              at + "21: 'extinction' in [fluid.medium] must be 3 numbers or one over time, not a "
                   "string");
    EXPECT_EQ(scene_error("fluid = 1"),
              "plume.toml:1:9: 'fluid' must be a list of tables, not a whole number");
    EXPECT_EQ(scene_error("fluid = [1]"),
              "plume.toml:1:10: 'fluid' must be a list of tables, not of a whole number");
}

TEST(Table, RangesAreNamedWithTheirUnit) {
    const auto fluid = [](const std::string& line) { return scene_error("[fluid]\n" + line); };
    const std::string at = "plume.toml:2:";
    EXPECT_EQ(fluid("domain.resolution = 0"),
              at + "21: 'resolution' in [fluid.domain] must be from 1 to 4096, not 0");
    EXPECT_EQ(fluid("domain.size = [1, 0, 1]"),
              at + "19: 'size' in [fluid.domain] must be above 0 m, not 0");
    EXPECT_EQ(fluid("medium.g = 1"),
              at + "12: 'g' in [fluid.medium] must be above -1 and below 1, not 1");
    EXPECT_EQ(fluid("levels = [0, 2]"), at + "14: 'levels' in [fluid] must be at most 1, not 2");
    EXPECT_EQ(fluid("start = nan"), at + "9: 'start' in [fluid] must be a finite number");
    EXPECT_EQ(fluid("start = -inf"), at + "9: 'start' in [fluid] must be a finite number");
    EXPECT_EQ(fluid("buoyancy = { t = [0, 1], v = [0, 101] }"),
              at + "34: 'buoyancy' in [fluid] must be from -100 to 100 m/s^2, not 101");
    EXPECT_EQ(scene_error("camera = { position = [0, 0, 0], fov_degrees = 1e39 }"),
              "plume.toml:1:48: 'fov_degrees' in [camera] is too large a number: 1e+39");
    EXPECT_EQ(fluid("medium.g = 0.999"), "");
}

struct Small {
    int n = 0;
};

TEST(Table, IntegersThatDoNotFitAreRefused) {
    static const Table<Small> table = Table<Small>("small", "").add("n", &Small::n);
    EXPECT_EQ(message_of([] { read(parse_toml("n = 2147483648", "f"), table); }),
              "f:1:5: 'n' in [small] is too large a number: 2147483648");
    EXPECT_EQ(read(parse_toml("n = -2147483648", "f"), table).n, -2147483648LL);
}

TEST(Table, KeyframesHaveAscendingTimesAndOneValueEach) {
    const auto fluid = [](const std::string& value) {
        return scene_error("[fluid]\nbuoyancy = " + value);
    };
    const std::string start = "'buoyancy' in [fluid] ",
                      example = "; as in { t = [0, 1], v = [0, 5] }";
    const Scene s =
        read_scene("[fluid]\nbuoyancy = { t = [0, 1], v = [0, 5], interpolation = \"step\" }\n");
    EXPECT_EQ(s.fluids[0].buoyancy.at(0.9), 0);
    EXPECT_EQ(fluid("{ t = [0, 0], v = [0, 1] }"),
              "plume.toml:2:22: " + start + "has key times 't' that do not ascend: 0 after 0");
    EXPECT_EQ(fluid("{ t = [0, 1], v = [0] }"),
              "plume.toml:2:30: " + start + "has 2 key times 't' but 1 values 'v'");
    EXPECT_EQ(fluid("{ t = [], v = [] }"),
              "plume.toml:2:18: " + start + "needs at least one keyframe");
    EXPECT_EQ(fluid("{ v = [] }"),
              "plume.toml:2:12: " + start + "needs a list of key times 't'" + example);
    EXPECT_EQ(fluid("{ t = [0] }"),
              "plume.toml:2:12: " + start + "needs a list of values 'v'" + example);
    EXPECT_EQ(
        fluid("{ t = [0], v = [0], w = 1 }"),
        "plume.toml:2:32: " + start + "has an unknown key 'w' in its keyframes; did you mean 't'?");
    EXPECT_EQ(fluid("{ t = [0], v = [0], interpolation = \"smoth\" }"),
              "plume.toml:2:48: " + start +
                  "has an unknown interpolation 'smoth'; did you mean 'smooth'?");
    EXPECT_EQ(fluid("{ t = [0, inf], v = [0, 1] }"),
              "plume.toml:2:22: " + start + "needs finite numbers of seconds as key times 't'");
}

TEST(Table, ChoicesOfferTheNearestWord) {
    EXPECT_EQ(scene_error("[fluid]\nadvection = \"mccormack\""),
              "plume.toml:2:13: 'advection' in [fluid] cannot be 'mccormack'; did you mean "
              "'maccormack'?");
    EXPECT_EQ(scene_error("[fluid]\nadvection = 1"),
              "plume.toml:2:13: 'advection' in [fluid] must be one of semi_lagrangian, maccormack, "
              "not a whole number");
}

TEST(Table, VariantsAreChosenByTheirType) {
    EXPECT_EQ(scene_error("[[light]]\ntype = \"sum\""),
              "plume.toml:2:8: unknown type 'sum' in [light]; did you mean 'sun'?");
    EXPECT_EQ(scene_error("[[light]]\ntype = 3"),
              "plume.toml:2:8: 'type' in [light] must be a string, not a whole number");
    EXPECT_EQ(scene_error("[[light]]\nangle = 3"),
              "plume.toml:1:1: key 'type' is missing in [light]; valid: sun, point");
    EXPECT_EQ(scene_error("[[light]]\ntype = \"point\"\nangle = 3"),
              "plume.toml:3:1: unknown key 'angle' in [light]; valid: position, name, type");
    EXPECT_EQ(std::get<Point>(read_scene("[ambient]\nposition = [1, 2, 3]").ambient).position.z, 3);
    EXPECT_EQ(std::get<Sun>(read_scene("[ambient]\ntype = \"sun\"").ambient), Sun{});
}

TEST(Table, RequiredKeysAreMissedWhereTheirTableIs) {
    EXPECT_EQ(scene_error("\n[camera]\n"), "plume.toml:2:1: key 'position' is missing in [camera]");
}

TEST(Table, NamesInAListAreUnique) {
    EXPECT_EQ(scene_error("[[fluid]]\nname = \"a\"\n[[fluid]]\nname = \"a\"\n"),
              "plume.toml:4:8: there are two of the name 'a' in [fluid]; the first is at "
              "plume.toml:2:8");
    EXPECT_EQ(scene_error("[[light]]\ntype = \"sun\"\nname = 4"),
              "plume.toml:3:8: 'name' in [light] must be a string, not a whole number");
}

TEST(Table, ChecksAcrossKeysFailAtTheKeyOrTheTable) {
    EXPECT_EQ(scene_error("[fluid]\ntime_step = 2"),
              "plume.toml:2:13: 'time_step' in [fluid] must be below a frame");
    EXPECT_EQ(scene_error("[fluid]\nlevels = []"),
              "plume.toml:1:1: [fluid] needs a level; add levels = [0.5]");
    EXPECT_EQ(scene_error("[fluid.domain]\nsize = [1000, 1, 1]"),
              "plume.toml:2:8: 'size' in [fluid.domain] must not be as flat");
}

struct Holder {
    Common common;
};

TEST(Table, FlatKeysOfAMemberAreReadAndWrittenAsIfDeclaredHere) {
    static const Table<Holder> table =
        Table<Holder>("holder", "").flat(&Holder::common, common_table());
    const Holder h = read(parse_toml("start = 4", "f"), table);
    EXPECT_EQ(h.common.start, 4);
    EXPECT_EQ(to_toml(to_value(h, table)), "name = \"\"\nstart = 4.0\n");
}

TEST(Table, DeclaringAKeyTwiceIsABug) {
    try {
        Table<Small>("small", "").add("n", &Small::n).add("n", &Small::n);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Internal);
    }
}

}  // namespace
}  // namespace gischt::test
