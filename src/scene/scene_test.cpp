// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "scene/builtin.h"
#include "scene/load.h"
#include "scene/preset.h"
#include "scene/preview.h"
#include "scene/world.h"
#include "schema/toml.h"

namespace gischt {
namespace {

std::string message_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Usage);
        return e.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

LoadedScene from_text(const std::string& text, const std::vector<std::string>& sets = {}) {
    return load_scene_tree("test", parse_toml(text, "test.toml"), "", sets);
}

TEST(BuiltinScenes, AllAreValidAndDescribed) {
    ASSERT_GE(builtin_scenes().size(), 4u);
    for (const BuiltinScene& b : builtin_scenes()) {
        const LoadedScene s = load_scene(b.name, "", {});
        EXPECT_FALSE(s.scene.description.empty()) << b.name;
        EXPECT_FALSE(s.scene.fluids.empty() && s.scene.media.empty() && s.scene.solids.empty())
            << b.name;
        for (const FluidSection& f : s.scene.fluids) EXPECT_NE(make_source(s.scene, f), nullptr);
    }
}

TEST(Scene, WrittenSceneReadsAsTheSame) {
    for (const BuiltinScene& b : builtin_scenes()) {
        const LoadedScene s = load_scene(b.name, "", {});
        EXPECT_EQ(load_scene_tree(b.name, parse_toml(s.toml, "again"), "", {}).hash, s.hash)
            << b.name;
    }
}

TEST(Scene, KeysThatScriptsRelyOnCanBeSet) {
    const LoadedScene s =
        load_scene("plume", "",
                   {"domain.resolution=40", "medium.extinction=3", "medium.albedo=0.5",
                    "medium.g=0.1", "render.method=march", "render.depth=1",
                    "camera.position=[1,2,3]", "camera.target=[0,0,1]", "camera.fov_degrees=20",
                    "film.width=100", "film.height=50", "light.daylight.strength=0.01"});
    const auto& fluid = std::get<FluidOf<SmokeParams>>(s.scene.fluids.at(0));
    EXPECT_EQ(fluid.source.domain.resolution, 40);
    EXPECT_EQ(fluid.common.medium.extinction.at(0), Vec3d(3.0));
    EXPECT_EQ(fluid.common.medium.albedo.at(0), Vec3d(0.5));
    EXPECT_EQ(s.scene.camera->position.at(0), Vec3d(1, 2, 3));
    EXPECT_EQ(s.scene.film.width, 100);
}

TEST(Scene, MessagesNamePlaceFactAndMend) {
    EXPECT_EQ(message_of([] { from_text("[[fluid]]\ntype = \"smoke\"\nviscosty = 1\n"); }),
              "test.toml:3:1: unknown key 'viscosty' in [fluid]; did you mean 'viscosity'?");
    EXPECT_NE(message_of([] {
                  from_text("[render]\nmethod = \"marsh\"\n");
              }).find("did you mean 'march'?"),
              std::string::npos);
    EXPECT_NE(message_of([] { load_scene("plme", "", {}); }).find("did you mean 'plume'?"),
              std::string::npos);
    EXPECT_NE(message_of([] { from_text("frames = [5, 2]\n"); }).find("first at most last"),
              std::string::npos);
}

TEST(Scene, HoldsMediaWithoutAFluid) {
    const char* text =
        "[[medium]]\nname = \"mist\"\ntype = \"height_fog\"\nscale_height = 4\n"
        "[[medium]]\ntype = \"atmosphere\"\n";
    const LoadedScene s = from_text(text, {"medium.mist.extinction=0.5", "medium.1.turbidity=3"});
    ASSERT_EQ(s.scene.media.size(), 2u);
    const auto& fog = std::get<HeightFog>(s.scene.media[0]);
    EXPECT_EQ(fog.scale_height.at(0), 4);
    EXPECT_EQ(fog.medium.extinction.at(0), Vec3d(0.5));
    EXPECT_EQ(fog.medium.albedo.at(0), Vec3d(0.99));
    EXPECT_EQ(std::get<PlanetAir>(s.scene.media[1]).turbidity, 3);
    Job job;
    const View view = World(s.scene, job).view({}, 1, job);
    EXPECT_EQ(view.media.size(), 4u);  // the air is three
    // Without a section the word is the fluid's; with neither it is nobody's.
    EXPECT_EQ(common_of(load_scene("plume", "", {"medium.g=0.25"}).scene.fluids[0]).medium.g.at(0),
              0.25);
    EXPECT_NE(message_of([] { from_text("", {"medium.g=0.2"}); }).find("has none"),
              std::string::npos);
    // The march must see an end.
    RenderSettings settings;
    EXPECT_NE(message_of([&] {
                  make_method("march", {})->render(view, settings, job);
              }).find("take method 'path'"),
              std::string::npos);
}

TEST(Scene, AFileTakesTheProcedurePlace) {
    const LoadedScene s =
        load_scene("cloud", "", {"fluid.file=/nowhere/a_####.vdb", "medium.g=0.3"});
    const auto& fluid = std::get<FluidOf<FileParams>>(s.scene.fluids.at(0));
    EXPECT_EQ(file_of_frame(fluid.source, 7), "/nowhere/a_0007.vdb");
    EXPECT_EQ(fluid.common.medium.g.at(0), 0.3);
    FileParams p;
    p.file = "x_%03d.vdb";
    p.frame_offset = 10;
    EXPECT_EQ(file_of_frame(p, 2), "x_012.vdb");
    p.file = "still.vdb";
    EXPECT_EQ(file_of_frame(p, 2), "still.vdb");
}

TEST(Scene, PathsCountFromTheFolderOfTheFile) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / "gischt_scene_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "s.toml") << "[fluid]\ntype = \"file\"\nfile = \"sub/a.vdb\"\n";
    const LoadedScene s = load_scene((folder / "s.toml").string(), "", {});
    EXPECT_EQ(std::get<FluidOf<FileParams>>(s.scene.fluids[0]).source.file,
              (folder / "sub/a.vdb").string());
    std::filesystem::remove_all(folder);
}

TEST(Scene, MotionHashIgnoresWhatOnlyLightSees) {
    const std::string base = load_scene("plume", "", {}).motion_hash;
    EXPECT_EQ(
        load_scene("plume", "", {"medium.g=0.9", "film.width=99", "light.daylight.strength=1"})
            .motion_hash,
        base);
    EXPECT_NE(load_scene("plume", "", {"domain.resolution=99"}).motion_hash, base);
    EXPECT_NE(load_scene("plume", "", {"solid.ball.radius=0.3"}).motion_hash, base);
    EXPECT_NE(load_scene("plume", "", {"fps=25"}).motion_hash, base);
}

TEST(Preview, HalvesWhatIsComputed) {
    const auto sets_of = [](const char* name, const std::vector<std::string>& sets = {}) {
        return preview_overrides(load_scene(name, "", sets).scene);
    };
    const auto first = [&](const char* name, const std::vector<std::string>& sets = {}) {
        const LoadedScene s = load_scene(name, "", sets_of(name, sets));
        return std::get<FluidOf<SmokeParams>>(s.scene.fluids[0]).source.domain.resolution;
    };
    EXPECT_EQ(first("plume"), 64);
    EXPECT_EQ(first("plume", {"domain.resolution=20"}), 16);
    EXPECT_TRUE(sets_of("plume", {"domain.resolution=9"}).empty());
    EXPECT_TRUE(sets_of("plume", {"fluid.file=a.vdb"}).empty());
    const LoadedScene cloud = load_scene("cloud", "", sets_of("cloud"));
    EXPECT_EQ(std::get<FluidOf<CloudParams>>(cloud.scene.fluids[0]).source.resolution, 128);
    const LoadedScene fog = load_scene("fogbank", "", sets_of("fogbank"));
    EXPECT_EQ(std::get<FluidOf<ProceduralParams>>(fog.scene.fluids[0]).source.resolution, 105);
}

TEST(Preset, EveryOneChangesTheLookAndNotTheMotion) {
    const LoadedScene plain = load_scene("plume", "", {});
    for (const std::string& name : preset_names()) {
        const LoadedScene s = load_scene("plume", name, {});
        EXPECT_NE(s.hash, plain.hash);
        EXPECT_EQ(s.motion_hash, plain.motion_hash);
        EXPECT_EQ(load_scene("plume", name, {"medium.g=0.11"}).scene.fluids.size(), 1u);
    }
    EXPECT_THROW(load_scene("plume", "lava", {}), Error);
}

}  // namespace
}  // namespace gischt
