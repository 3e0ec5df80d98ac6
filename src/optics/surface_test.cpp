// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "optics/surface_params.h"

namespace gischt {
namespace {

Ray along(const Vec3d& origin, const Vec3d& direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    return ray;
}

SurfaceSet ball_on_the_ground() {
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d{0, 0, 1});
    ball.material.albedo = {0.8, 0.1, 0.1};
    GroundSurface ground;
    ground.material.albedo = {0.2, 0.2, 0.2};
    ground.material.checker = {0.7, 0.7, 0.7};
    ground.material.checker_size = 1;
    return SurfaceSet({ball, ground}, 0);
}

TEST(Surface, NearestIsHitWithItsOwnColor) {
    const SurfaceSet set = ball_on_the_ground();
    const auto ball = set.intersect(along({0, -5, 1}, {0, 1, 0}));
    ASSERT_TRUE(ball);
    EXPECT_NEAR(ball->t, 4, 1e-12);
    EXPECT_EQ(ball->albedo, Vec3f(0.8f, 0.1f, 0.1f));
    EXPECT_NEAR(ball->normal.y, -1, 1e-12);
    EXPECT_EQ(ball->surface, 0);
    const auto floor = set.intersect(along({5.5, 0.5, 3}, {0, 0, -1}));
    ASSERT_TRUE(floor);
    EXPECT_EQ(floor->surface, 1);
    EXPECT_FALSE(set.intersect(along({5, 0, 3}, {0, 0, 1})));
    EXPECT_FALSE(SurfaceSet().intersect(along({0, 0, 0}, {1, 0, 0})));
}

TEST(Surface, CheckerFieldsAlternate) {
    const SurfaceSet set = ball_on_the_ground();
    const auto red = [&](double x, double y) {
        return set.intersect(along({x, y, 5}, {0, 0, -1}))->albedo.x;
    };
    for (int i = 2; i < 6; ++i) {
        EXPECT_NE(red(i + 0.3, 2.5), red(i + 1.3, 2.5));
        EXPECT_NE(red(2.5, i + 0.3), red(2.5, i + 1.3));
        EXPECT_EQ(red(i + 0.3, 2.5), red(i + 0.9, 2.9));
    }
}

TEST(Surface, ShadowRaysLeaveWhereTheyStart) {
    const SurfaceSet set = ball_on_the_ground();
    const auto top = set.intersect(along({0.3, 0.2, 9}, {0, 0, -1}));
    ASSERT_TRUE(top);
    EXPECT_FALSE(set.is_blocked(leaving_ray(*top, {0, 0, 1})));
    const auto below = set.intersect(along({3, 0, 4}, normalize(Vec3d{-3, 0, -4})));
    ASSERT_TRUE(below);
    EXPECT_EQ(below->surface, 0);
    // The ground under the ball lies in its shadow, also for a light that is near.
    SurfaceHit ground;
    ground.point = {0.1, 0, 0};
    ground.normal = {0, 0, 1};
    Ray up = leaving_ray(ground, {0, 0, 1});
    EXPECT_TRUE(set.is_blocked(up));
    up.t_max = 0.001;
    EXPECT_FALSE(set.is_blocked(up));
}

TEST(Surface, MovesWithItsKeys) {
    SphereSurface ball;
    ball.center = Keyed<Vec3d>({0, 2}, {Vec3d{0, 0, 0}, Vec3d{4, 0, 0}});
    const auto at = [&](double t) {
        return SurfaceSet({ball}, t).intersect(along({2, -5, 0}, {0, 1, 0})).has_value();
    };
    EXPECT_FALSE(at(0));
    EXPECT_TRUE(at(1));
    EXPECT_FALSE(at(2));
}

TEST(Surface, GroundTakesTheUpAxisOfTheScene) {
    GroundSurface ground;
    const SurfaceSet set({ground}, 0, {0, 1, 0});
    const auto hit = set.intersect(along({1, 3, 2}, {0, -1, 0}));
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 3, 1e-12);
    EXPECT_NEAR(hit->normal.y, 1, 1e-12);
    EXPECT_TRUE(set.bounds().is_empty());
}

TEST(Surface, BoxTurnsAndRefusesNoSize) {
    BoxSurface box;
    box.size = {2, 2, 2};
    box.rotation_degrees = Keyed<Vec3d>(Vec3d{0, 0, 45});
    const auto hit = SurfaceSet({box}, 0).intersect(along({0, -5, 0}, {0, 1, 0}));
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 5 - std::sqrt(2.0), 1e-9);
    box.size.y = 0;
    EXPECT_THROW(SurfaceSet({box}, 0), Error);
    SphereSurface ball;
    ball.radius = Keyed<double>(-1);
    EXPECT_THROW(SurfaceSet({ball}, 0), Error);
}

TEST(Surface, ReadsFromATable) {
    Value table;
    table.set("type", "sphere");
    table.set("radius", 2);
    table.set("albedo", 0.25);
    const auto s = std::get<SphereSurface>(read(table, surface_variants()));
    EXPECT_EQ(s.radius.at(0), 2);
    EXPECT_EQ(s.material.albedo, Vec3d(0.25, 0.25, 0.25));
}

}  // namespace
}  // namespace gischt
