// SPDX-License-Identifier: Apache-2.0
#include "optics/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "optics/orientation.h"

namespace gischt {
namespace {

CameraParams looking_north() {
    CameraParams p;
    p.position = Keyed<Vec3d>(Vec3d{1, -4, 2});
    p.target = Keyed<Vec3d>(Vec3d{1, 0, 2});
    p.fov_degrees = Keyed<double>(50);
    return p;
}

TEST(Camera, FieldOfViewIsTheFullVerticalOne) {
    const Camera camera(looking_north(), 0, 200, 100);
    const Ray top = camera.ray(100, 0), bottom = camera.ray(100, 100);
    EXPECT_NEAR(std::acos(dot(top.direction, bottom.direction)), radians(50), 1e-12);
    EXPECT_GT(top.direction.z, 0);
    EXPECT_GT(camera.ray(200, 50).direction.x, 0);
    const Ray middle = camera.ray(100, 50);
    EXPECT_NEAR(length(middle.direction - Vec3d{0, 1, 0}), 0, 1e-15);
    // Square pixels: twice as wide is twice the tangent.
    const Vec3d right = camera.ray(200, 50).direction;
    EXPECT_NEAR(right.x / right.y, 2 * std::tan(radians(25)), 1e-12);
}

TEST(Camera, ProjectInvertsRay) {
    for (const Projection kind : {Projection::Perspective, Projection::Orthographic}) {
        CameraParams p = looking_north();
        p.projection = kind;
        p.roll_degrees = Keyed<double>(17);
        const Camera camera(p, 0, 320, 180);
        for (const Vec2d pixel : {Vec2d{0, 0}, Vec2d{10.25, 170}, Vec2d{319, 3}}) {
            const Ray ray = camera.ray(pixel.x, pixel.y);
            EXPECT_NEAR(length(ray.direction), 1, 1e-14);
            const auto back = camera.project(ray.at(7));
            ASSERT_TRUE(back);
            EXPECT_NEAR(back->x, pixel.x, 1e-9);
            EXPECT_NEAR(back->y, pixel.y, 1e-9);
            EXPECT_NEAR(camera.depth(ray, 7), dot(ray.at(7) - camera.position(), camera.forward()),
                        1e-12);
        }
    }
    const Camera camera(looking_north(), 0, 320, 180);
    EXPECT_FALSE(camera.project({1, -5, 2}));
}

TEST(Camera, OrthographicShowsItsHeight) {
    CameraParams p = looking_north();
    p.projection = Projection::Orthographic;
    p.height = Keyed<double>(3);
    const Camera camera(p, 0, 400, 300);
    EXPECT_NEAR(camera.ray(0, 0).origin.z - camera.ray(0, 300).origin.z, 3, 1e-12);
    EXPECT_NEAR(camera.ray(400, 0).origin.x - camera.ray(0, 0).origin.x, 4, 1e-12);
    EXPECT_NEAR(camera.pixel_size(5), 0.01, 1e-15);
}

TEST(Camera, UpAxisOnlyRollsThePicture) {
    // The same scene with y for up, that is turned by -90 degrees around x.
    CameraParams p = looking_north();
    p.position = Keyed<Vec3d>(Vec3d{1, 2, 4});
    p.target = Keyed<Vec3d>(Vec3d{1, 2, 0});
    const Camera z(looking_north(), 0, 64, 48), y(p, 0, 64, 48, {0, 1, 0});
    const Vec3d a = z.ray(5, 7).direction, b = y.ray(5, 7).direction;
    EXPECT_NEAR(a.x, b.x, 1e-15);
    EXPECT_NEAR(a.y, -b.z, 1e-15);
    EXPECT_NEAR(a.z, b.y, 1e-15);
}

TEST(Camera, LookingAlongUpIsNoAccident) {
    CameraParams p;
    p.position = Keyed<Vec3d>(Vec3d{0, 0, 5});
    p.target = Keyed<Vec3d>(Vec3d{0, 0, 0});
    const Camera camera(p, 0, 64, 48);
    EXPECT_NEAR(length(camera.right()), 1, 1e-12);
    EXPECT_NEAR(dot(camera.right(), camera.up()), 0, 1e-12);
    p.target = p.position;
    EXPECT_THROW(Camera(p, 0, 64, 48), Error);
}

TEST(Camera, KeysMoveIt) {
    CameraParams p = looking_north();
    p.position = Keyed<Vec3d>({0, 1}, {Vec3d{0, -4, 0}, Vec3d{0, -2, 0}});
    EXPECT_EQ(Camera(p, 0.5, 8, 8).position(), Vec3d(0, -3, 0));
}

// All corners are inside, and on at least one axis both sides touch.
TEST(Camera, FramingIsTight) {
    const Box3d boxes[] = {{{0, 0, 0}, {1, 1, 2}}, {{-30, 5, 7}, {90, 25, 9}}};
    for (const Box3d& box : boxes) {
        for (const double azimuth : {0.0, 37.0, 210.0}) {
            for (const double aspect : {1.75, 0.6}) {
                Framing framing{.azimuth_degrees = azimuth, .aspect = aspect};
                const int height = 1000, width = int(std::lround(height * aspect));
                const Camera camera(fit_camera(box, framing), 0, width, height);
                Vec2d low{1e9, 1e9}, high{-1e9, -1e9};
                for (int c = 0; c < 8; ++c) {
                    const auto p =
                        camera.project({c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y,
                                        c & 4 ? box.hi.z : box.lo.z});
                    ASSERT_TRUE(p);
                    low = {std::min(low.x, p->x), std::min(low.y, p->y)};
                    high = {std::max(high.x, p->x), std::max(high.y, p->y)};
                }
                const double mx = 0.05 * width, my = 0.05 * height, e = 1e-6 * width;
                EXPECT_GE(low.x, mx - e);
                EXPECT_LE(high.x, width - mx + e);
                EXPECT_GE(low.y, my - e);
                EXPECT_LE(high.y, height - my + e);
                const bool fills_width =
                    std::abs(low.x - mx) < e && std::abs(high.x - width + mx) < e;
                const bool fills_height =
                    std::abs(low.y - my) < e && std::abs(high.y - height + my) < e;
                EXPECT_TRUE(fills_width || fills_height);
            }
        }
    }
    EXPECT_THROW(fit_camera(Box3d::empty(), {}), Error);
}

TEST(Orientation, AzimuthIsMeasuredFromTheFront) {
    EXPECT_NEAR(length(horizon_direction(0, 0, {0, 0, 1}) - Vec3d{0, -1, 0}), 0, 1e-15);
    EXPECT_NEAR(length(horizon_direction(90, 0, {0, 0, 1}) - Vec3d{1, 0, 0}), 0, 1e-15);
    EXPECT_NEAR(length(horizon_direction(0, 0, {0, 1, 0}) - Vec3d{0, 0, 1}), 0, 1e-15);
    EXPECT_NEAR(length(horizon_direction(90, 0, {0, 1, 0}) - Vec3d{1, 0, 0}), 0, 1e-15);
    EXPECT_NEAR(length(horizon_direction(12, 90, {0, 1, 0}) - Vec3d{0, 1, 0}), 0, 1e-15);
    EXPECT_NEAR(horizon_direction(12, 30, {0, 0, -1}).z, -0.5, 1e-15);
}

}  // namespace
}  // namespace gischt
