// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "artist.h"
#include "orbit.h"
#include "stage.h"

namespace gischt {
namespace {

CameraParams params(const Vec3d& position, const Vec3d& target) {
    CameraParams p;
    p.position = position;
    p.target = target;
    return p;
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
    EXPECT_LT(length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(Orbit, BeginsWhereTheCameraStands) {
    for (const Vec3d& up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, normalize(Vec3d{1, 2, 3})}) {
        const Vec3d eye{3, -4, 2}, target{0.5, 0.25, -1};
        const Orbit orbit(params(eye, target), 0, up);
        expect_near(orbit.position(), eye, 1e-12);
        expect_near(orbit.params().target.at(0), target, 1e-15);
    }
}

TEST(Orbit, TurnsAroundItsTargetAndNotOverThePoles) {
    const Vec3d up{0, 0, 1}, target{1, 2, 3};
    Orbit orbit(params({4, -2, 5}, target), 0, up);
    const double distance = orbit.distance(), height = orbit.position().z;
    for (int i = 0; i < 8; ++i) orbit.turn(0.25 * 3.141592653589793, 0);
    expect_near(orbit.position(), {4, -2, 5}, 1e-12);  // once around
    orbit.turn(1, 0);
    EXPECT_NEAR(orbit.position().z, height, 1e-12);
    for (int i = 0; i < 100; ++i) orbit.turn(0, 0.1);
    EXPECT_LT(orbit.position().z - target.z, distance);
    EXPECT_GT(orbit.position().z - target.z, 0.999 * distance);
    EXPECT_NEAR(length(orbit.position() - target), distance, 1e-12);
}

// A pan by one height moves what was in the middle to the edge and as far again.
TEST(Orbit, PansInHeightsOfThePicture) {
    const Vec3d target{0, 0, 1};
    Orbit orbit(params({0, -5, 2}, target), 0, {0, 0, 1});
    orbit.pan(0, 0.5);
    const Camera camera(orbit.params(), 0, 200, 100);
    const auto there = camera.project(target);
    ASSERT_TRUE(there.has_value());
    EXPECT_NEAR(there->y, 100, 1e-6);
    EXPECT_NEAR(there->x, 100, 1e-6);
}

TEST(Orbit, FindsThePointUnderTheMouse) {
    const Vec3d target{0, 0, 1};
    const Orbit orbit(params({2, -5, 2}, target), 0, {0, 0, 1});
    const Camera camera(orbit.params(), 0, 320, 180);
    const Vec3d p = Orbit::point_at(camera, {40, 150}, target);
    const auto back = camera.project(p);
    ASSERT_TRUE(back.has_value());
    EXPECT_NEAR(back->x, 40, 1e-6);
    EXPECT_NEAR(back->y, 150, 1e-6);
    EXPECT_NEAR(dot(p - target, camera.forward()), 0, 1e-9);
}

const std::vector<std::string> small{"fluid.domain.resolution=16", "render.slices.resolution=16"};

SceneLoader plume() {
    return [](const std::vector<std::string>& overrides, Job&) {
        std::vector<std::string> all = small;
        all.insert(all.end(), overrides.begin(), overrides.end());
        return load_scene("plume", "", all);
    };
}

// Waits for a state that must come; the time limit only ends a test that would fail.
template <class F>
bool comes(F&& holds) {
    for (int i = 0; i < 6000; ++i) {
        if (holds()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

bool shows(const Stage& stage, int frame) {
    const auto shot = stage.latest();
    return shot && shot->frame == frame;
}

double mass(const Snapshot& shot) {
    const Field* density = shot.view.frames[0]->find("density");
    const TileField<float>& values = density->component[0];
    double sum = 0;
    for (int t = 0; t < values.map().size(); ++t) {
        for (int i = 0; i < tile_values; ++i) sum += static_cast<double>(values.tile(t)[i]);
    }
    return sum;
}

TEST(Stage, GoesForwardAndBackToTheSameFrames) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); })) << stage.error();
    stage.seek(4);
    ASSERT_TRUE(comes([&] { return shows(stage, 4); })) << stage.error();
    const double at_4 = mass(*stage.latest());
    stage.seek(1);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    EXPECT_LT(mass(*stage.latest()), at_4);
    stage.seek(4);
    ASSERT_TRUE(comes([&] { return shows(stage, 4); }));
    EXPECT_EQ(mass(*stage.latest()), at_4);
}

TEST(Stage, KeepsTheFramesWhereOnlyTheLooksChange) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    stage.seek(3);
    ASSERT_TRUE(comes([&] { return shows(stage, 3); }));
    const auto before = stage.latest();
    stage.set_overrides({"film.exposure=1"});
    ASSERT_TRUE(comes([&] { return stage.latest()->scene != before->scene; }));
    EXPECT_EQ(stage.latest()->frame, 3);
    EXPECT_EQ(stage.latest()->view.frames[0], before->view.frames[0]);
    stage.set_overrides({"fluid.vorticity_confinement=0"});
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
}

TEST(Stage, TellsWhatItRefusesAndGoesOn) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    stage.set_overrides({"fluid.domain.resolutoin=16"});
    ASSERT_TRUE(comes([&] { return !stage.error().empty(); }));
    EXPECT_NE(stage.error().find("resolution"), std::string::npos) << stage.error();
    stage.set_overrides({});
    ASSERT_TRUE(comes([&] { return stage.error().empty(); }));
    stage.seek(2);
    EXPECT_TRUE(comes([&] { return shows(stage, 2); }));
}

// A hand that gives smoke and blows: there is more of it afterwards, and reset forgets it.
TEST(Stage, IsStirred) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    stage.seek(2);
    ASSERT_TRUE(comes([&] { return shows(stage, 2); }));
    const double calm = mass(*stage.latest());
    stage.reset();
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    const Box3d box = stage.latest()->view.media[0]->bounds();
    EmitterParams hand;
    hand.position = 0.5 * (box.lo + box.hi);
    hand.radius = 0.3;
    hand.density = Keyed<double>(1.0);
    hand.velocity = Keyed<Vec3d>(Vec3d{3, 0, 0});
    hand.rate = 100.0;
    stage.stir(hand);
    stage.seek(2);
    ASSERT_TRUE(comes([&] { return shows(stage, 2); }));
    EXPECT_GT(mass(*stage.latest()), 1.2 * calm);
    stage.stir(std::nullopt);
    stage.reset();
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    stage.seek(2);
    ASSERT_TRUE(comes([&] { return shows(stage, 2); }));
    EXPECT_EQ(mass(*stage.latest()), calm);
}

TEST(Artist, DrawsWhatIsWishedForLast) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    const auto shot = stage.latest();
    Artist artist;
    for (int i = 0; i < 20; ++i) artist.wish({shot, shot->camera, {64 + i, 36}, "slices", 1});
    const std::uint64_t last = artist.wish({shot, shot->camera, {96, 54}, "slices", 1});
    std::shared_ptr<const Picture> picture;
    ASSERT_TRUE(comes([&] {
        if (const auto p = artist.take()) picture = p;
        return picture && picture->wish == last;
    })) << artist.error(last);
    EXPECT_EQ(picture->image.width, 96);
    double sum = 0;
    for (const float v : picture->image.channel("G")) sum += static_cast<double>(v);
    EXPECT_GT(sum, 0);
}

TEST(Artist, TracesUntilItIsToldToStop) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    const auto shot = stage.latest();
    Artist artist;
    artist.wish({shot, shot->camera, {48, 27}, "path", 1 << 20});
    ASSERT_TRUE(comes([&] { return artist.take() != nullptr; }));
    const std::uint64_t next = artist.wish({shot, shot->camera, {32, 18}, "march", 1});
    std::shared_ptr<const Picture> picture;
    EXPECT_TRUE(comes([&] {
        if (const auto p = artist.take()) picture = p;
        return picture && picture->wish == next && picture->is_whole;
    })) << artist.error(next);
}

TEST(Artist, SaysWhatAMethodCannotDo) {
    Stage stage(plume(), std::nullopt);
    ASSERT_TRUE(comes([&] { return shows(stage, 1); }));
    const auto shot = stage.latest();
    Artist artist;
    const std::uint64_t id = artist.wish({shot, shot->camera, {32, 18}, "billboards", 1});
    ASSERT_TRUE(comes([&] { return !artist.error(id).empty() || artist.take(); }));
    EXPECT_FALSE(artist.error(id).empty());
}

}  // namespace
}  // namespace gischt
