// SPDX-License-Identifier: Apache-2.0
#include "scene/world.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fluid/smoke_source.h"
#include "scene/load.h"
#include "schema/toml.h"

namespace gischt {
namespace {

// A scene of one fluid from a file, which nobody opens here.
Scene scene_of(const std::string& keys) {
    return load_scene_tree("test",
                           parse_toml("[fluid]\ntype = \"file\"\nfile = \"a.vdb\"\n" + keys, "t"),
                           "", {})
        .scene;
}

Field constant_field(const std::vector<float>& values) {
    Field f;
    for (std::size_t c = 0; c < values.size(); ++c) {
        f.component.emplace_back(TileMap::box(Vec3i(8)), values[c]);
        f.background[c] = values[c];
    }
    f.to_world = Transform::scale_translate(0.5, {1, 0, 0});
    return f;
}

// The first value of each component of a field of the frame that the view has.
std::vector<float> seen(const Scene& scene, const std::string& name) {
    auto frame = std::make_shared<Frame>();
    frame->fields["density"] = constant_field({1});
    frame->fields["distance"] = constant_field({0.5f});
    frame->fields["distance"].kind = FieldClass::LevelSet;
    frame->fields["velocity"] = constant_field({1, 2, 3});
    frame->fields["vorticity"] = constant_field({1, 2, 3});
    frame->fields["Cd"] = constant_field({1, 2, 3});
    Job job;
    const View view = World(scene, job).view({frame}, 1, job);
    std::vector<float> out;
    const Field& f = *view.frames.at(0)->find(name);
    for (std::size_t c = 0; c < f.component.size(); ++c) {
        out.push_back(f.component[c].values().front());
        EXPECT_EQ(f.background[c], out.back());
    }
    return out;
}

void expect_near(const std::vector<float>& a, const std::vector<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5f) << i;
}

TEST(World, TurnsAndStretchesWhatPointsSomewhere) {
    // A quarter turn around z takes x to y, and the fluid is three times as large.
    const Scene scene = scene_of("rotate_degrees = [0, 0, 90]\nscale = 3\ntranslate = [5, 6, 7]\n");
    expect_near(seen(scene, "velocity"), {-6, 3, 9});
    expect_near(seen(scene, "vorticity"), {-2, 1, 3});  // 1/s knows no length
    expect_near(seen(scene, "Cd"), {1, 2, 3});
    expect_near(seen(scene, "distance"), {1.5f});
    expect_near(seen(scene, "density"), {1});
}

TEST(World, LeavesFluidsWhereTheyAre) {
    const Scene scene = scene_of("");
    for (const char* name : {"velocity", "vorticity", "Cd"}) {
        expect_near(seen(scene, name), {1, 2, 3});
    }
}

// What is carried along must stay on its way: a point of the fluid and the end of its velocity's
// arrow after a second are the same before and after the placement.
TEST(World, ArrowsEndWhereTheFluidTakesThem) {
    const Scene scene = scene_of("rotate_degrees = [20, -50, 130]\nscale = 0.7\n");
    const Transform placement = common_of(scene.fluids[0]).placement();
    const std::vector<float> v = seen(scene, "velocity");
    const Vec3d start(0.3, -0.2, 0.9), arrow(1, 2, 3);
    const Vec3d moved = placement.point(start) + Vec3d(v[0], v[1], v[2]);
    EXPECT_LT(length(moved - placement.point(start + arrow)), 1e-5);
}

// 2.5 m, five voxels, while the film is exposed; beside a fluid that is slow.
TEST(World, BlursFluidsByTheirVelocity) {
    const auto frame_of = [](float speed, bool has_velocity) {
        auto frame = std::make_shared<Frame>();
        frame->fields["density"] = constant_field({1});
        frame->fields["density"].background = {};
        if (has_velocity) frame->fields["velocity"] = constant_field({speed, 0, 0});
        return frame;
    };
    const std::string two = "[[fluid]]\ntype = \"file\"\nfile = \"a.vdb\"\n";
    const auto scene_with = [&](const std::string& text) {
        return load_scene_tree("test", parse_toml(text, "t"), "", {}).scene;
    };
    Job job;
    const Scene scene =
        scene_with("fps = 10\n" + two + two + "[film]\nshutter = 5\n[render]\nmethod = \"path\"\n");
    const View view = World(scene, job).view({frame_of(5, true), frame_of(1, true)}, 1, job);
    ASSERT_EQ(view.moving_media.size(), 9u);
    EXPECT_EQ(view.moving_media[4], view.media);
    EXPECT_NE(view.moving_media[0][0], view.moving_media[1][0]);
    EXPECT_EQ(view.moving_media[0][1], view.moving_media[2][1]);  // three are enough for the slow
    EXPECT_NE(view.moving_media[2][1], view.moving_media[3][1]);
    // From [1, 5] m it is 4 / 9 of 2.5 m to the left at the first moment, to the right at the last;
    // next to a sharp edge cubic interpolation overshoots by some per cent.
    const auto density = [&](int part, double x) {
        return view.moving_media[static_cast<std::size_t>(part)][0]->density({x, 2, 2});
    };
    EXPECT_EQ(density(4, 0.5), 0);
    EXPECT_NEAR(density(0, 0.5), 1, 0.08);
    EXPECT_EQ(density(0, 4.5), 0);
    EXPECT_NEAR(density(8, 5.5), 1, 0.08);
    ASSERT_TRUE(view.around);
    EXPECT_NEAR(view.around->interval, 0.1, 1e-12);

    const Scene march = scene_with("fps = 10\n" + two + "[film]\nshutter = 5\n");
    EXPECT_TRUE(World(march, job).view({frame_of(5, true)}, 1, job).moving_media.empty());
    const Scene still =
        scene_with("fps = 10\n" + two +
                   "blur_moments = 1\n[film]\nshutter = 5\n[render]\nmethod = \"path\"\n");
    EXPECT_TRUE(World(still, job).view({frame_of(5, true)}, 1, job).moving_media.empty());
}

// A cloud of gas blows along x and carries the particles that another fluid gives.
TEST(World, ParticlesGoWithAnotherFluidOfTheScene) {
    const std::string text = R"(
[[fluid]]
name = "air"
type = "smoke"
initial_velocity = [1, 0, 0]
output = { velocity = "all" }
domain = { resolution = 16, min = [0, 0, 0], max = [1, 1, 1] }
[[fluid]]
name = "dust"
type = "particles"
motion = "tracer"
domain = { resolution = 16, min = [0, 0, 0], max = [1, 1, 1] }
flow = { fluid = "air" }
[[fluid.source]]
position = [0.2, 0.5, 0.5]
rate = 1000
)";
    const Scene scene = load_scene_tree("test", parse_toml(text, "t"), "", {}).scene;
    Job job;
    const Frame frame = make_source(scene, scene.fluids.at(1))->frame(6, job);
    const Particles& dust = frame.particles.at("particles");
    EXPECT_NEAR(static_cast<double>(dust.size()), 250, 1);
    for (std::size_t i = 0; i < dust.size(); ++i) {
        EXPECT_NEAR(dust.position[i].x, 0.2 + static_cast<double>(dust.age[i]), 1e-3);
    }
    // Turned, the air blows along y.
    const Scene turned =
        load_scene_tree("test", parse_toml(text, "t"), "",
                        {"fluid.air.rotate_degrees=[0,0,90]", "fluid.air.translate=[1,0,0]",
                         "fluid.dust.source.0.position=[0.5,0.2,0.5]"})
            .scene;
    const Frame along_y = make_source(turned, turned.fluids.at(1))->frame(6, job);
    const Particles& up = along_y.particles.at("particles");
    EXPECT_FALSE(up.is_empty());
    for (std::size_t i = 0; i < up.size(); ++i) {
        EXPECT_NEAR(up.position[i].y, 0.2 + static_cast<double>(up.age[i]), 1e-3);
    }
    for (const char* name : {"airs", "dust"}) {
        const std::string set = std::string("fluid.dust.flow.fluid=") + name;
        EXPECT_THROW(load_scene_tree("test", parse_toml(text, "t"), "", {set}), Error) << name;
    }
}

TEST(World, PlacesParticlesWithTheirFluid) {
    const Scene scene = scene_of("rotate_degrees = [0, 0, 90]\nscale = 3\ntranslate = [5, 6, 7]\n");
    auto frame = std::make_shared<Frame>();
    frame->fields["density"] = constant_field({1});
    Particles& p = frame->particles["drops"];
    p.resize(1);
    p.position[0] = {1, 0, 0};
    p.velocity[0] = {1, 2, 3};
    p.radius[0] = 0.5f;
    Job job;
    const View view = World(scene, job).view({frame}, 1, job);
    const Particles& seen = view.frames.at(0)->particles.at("drops");
    EXPECT_LT(length(seen.position[0] - Vec3d(5, 9, 7)), 1e-12);
    EXPECT_LT(length(seen.velocity[0] - Vec3f(-6, 3, 9)), 1e-5f);
    EXPECT_FLOAT_EQ(seen.radius[0], 1.5f);
}

// A tetrahedron with its corner at the origin, of 1/6 of the cube of its legs.
TEST(World, FillsTheMeshOfAFile) {
    const auto file = std::filesystem::temp_directory_path() / "gischt_world_test_corner.obj";
    const auto write = [&](const char* faces) {
        std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" << faces;
    };
    const std::string keys =
        "[fluid]\ntype = 'procedural'\nshape = 'mesh'\nmin = [0, 0, 0]\nmax = [3, 3, 3]\n"
        "resolution = 90\nedge = 0.01\nposition = [0.5, 0.5, 0.5]\n"
        "mesh = { scale = 2, file = '" +
        file.string() + "' }\n";
    const Scene scene = load_scene_tree("test", parse_toml(keys, "t"), "", {}).scene;
    const auto filled = [&] {
        Job job;
        const Frame frame = make_source(scene, scene.fluids[0])->frame(1, job);
        double sum = 0;
        for (const float v : frame.find("density")->component[0].values()) sum += double(v);
        return sum / (30.0 * 30 * 30);
    };
    write("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    // The edge is less than half a cell, so a cell is in or out; their middles lie on either side
    // of the slanting face alike.
    EXPECT_NEAR(filled(), 8.0 / 6, 0.003);
    write("f 1 3 2\nf 1 2 4\nf 1 4 3\n");
    EXPECT_THROW(filled(), Error);  // open
    std::filesystem::remove(file);
    EXPECT_THROW(filled(), Error);  // missing
}

// A body of a file stands in the smoke's way, as the scene puts it, and smokes; one with a hole is
// reported and stands in nothing's way.
TEST(World, SmokeMeetsTheMeshOfAFile) {
    const auto file = std::filesystem::temp_directory_path() / "gischt_world_test_body.obj";
    const auto write = [&](const char* faces) {
        std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" << faces;
    };
    const std::string keys =
        "[fluid]\nname = 'air'\ntype = 'smoke'\ndomain = { resolution = 16, max = [2, 2, 2] }\n"
        "[[fluid.source]]\nshape = 'mesh'\ndensity = 1\nposition = [0.2, 0.3, 0.4]\n"
        "mesh = { scale = 1.5, file = '" +
        file.string() +
        "' }\n"
        "[[fluid.solid_heat]]\nsolid = 'corner'\ntemperature = 350\n"
        "[[solid]]\ntype = 'mesh'\nname = 'corner'\nup = 'z'\nscale = 2\ntranslate = [0.1, 0, 0]\n"
        "rotate_degrees = [0, 0, 90]\nfile = '" +
        file.string() + "'\n";
    const Scene scene = load_scene_tree("test", parse_toml(keys, "t"), "", {}).scene;
    const auto solids = [&] {
        const auto source = make_source(scene, scene.fluids[0]);
        return dynamic_cast<SmokeSource&>(*source).solver().world().solids;
    };
    write("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    ASSERT_EQ(solids().size(), 1u);
    const PlacedSolid placed(solids()[0], 0);
    // Turned by 90 degrees about z, the legs along x and y are twice those along y and -x.
    EXPECT_TRUE(placed.is_inside({0.1 - 0.2, 0.2, 0.2}));
    EXPECT_FALSE(placed.is_inside({0.1 + 0.2, 0.2, 0.2}));
    EXPECT_NEAR(placed.bounds().lo.x, 0.1 - 2, 1e-9);
    EXPECT_NEAR(placed.bounds().hi.y, 2, 1e-9);
    EXPECT_EQ(solids()[0].name, "corner");
    EXPECT_EQ(solids()[0].temperature->at(0), 350);
    std::vector<std::string> heard;
    Job job;
    job.on_message = [&](Job::Level, std::string_view text) { heard.emplace_back(text); };
    report_unmet_solids(scene, scene.fluids[0], job);
    EXPECT_TRUE(heard.empty());
    write("f 1 3 2\nf 1 2 4\nf 1 4 3\n");
    report_unmet_solids(scene, scene.fluids[0], job);
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_NE(heard[0].find("'corner' is a mesh that is not closed"), std::string::npos);
    EXPECT_THROW(solids(), Error);  // its source has no inside
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace gischt
