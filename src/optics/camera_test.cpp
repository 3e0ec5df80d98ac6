// SPDX-License-Identifier: Apache-2.0
#include "optics/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "optics/aperture.h"
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

// Where a point appears through one point of the lens: a ray's place in the point's plane is linear
// in the place of the picture.
Vec2d seen_through(const Camera& camera, const Vec3d& point, Vec2f lens) {
    const double depth = dot(point - camera.position(), camera.forward());
    auto in_plane = [&](double x, double y) {
        const Ray ray = camera.ray(x, y, lens);
        const double t = (depth - camera.depth(ray, 0)) / dot(ray.direction, camera.forward());
        const Vec3d miss = ray.at(t) - point;
        return Vec2d{dot(miss, camera.right()), dot(miss, camera.up())};
    };
    const Vec2d miss = in_plane(0, 0), px = in_plane(1, 0), py = in_plane(0, 1);
    return {-miss.x / (px.x - miss.x), -miss.y / (py.y - miss.y)};
}

// The circle of confusion of a thin lens. Focal length f = 35 mm, f/2, focus at s: the image of a
// point at z is a disc of the diameter (f/2) |z - s| / z * v / s on the sensor, v = f being the
// distance from lens to sensor (the field of view is kept while focussing).
TEST(Camera, BlursByTheCircleOfConfusion) {
    const double sensor = 0.024, focal = 0.035, s = 3;
    CameraParams p = looking_north();
    p.fov_degrees = 2 * std::atan(0.5 * sensor / focal) * 180 / pi;
    p.f_number = 2.0;
    p.focus_distance = Keyed<double>(s);
    const Camera camera(p, 0, 1920, 1080);
    EXPECT_NEAR(camera.lens_radius(), focal / 4, 1e-12);
    for (const double z : {0.7, 2.0, 3.0, 5.0, 400.0}) {
        const Vec3d point = Vec3d(1, -4, 2) + Vec3d(0.1, 1, 0.2) * z;
        const auto middle = camera.project(point);
        double largest = 0, mean = 0;
        const int n = 64;
        for (int i = 0; i < n * n; ++i) {
            const Vec2f u{(static_cast<float>(i % n) + 0.5f) / n,
                          (static_cast<float>(i / n) + 0.5f) / n};
            const Vec2d at = seen_through(camera, point, u);
            const double r = std::hypot(at.x - middle->x, at.y - middle->y);
            largest = std::max(largest, r);
            mean += r * r / (n * n);
        }
        const double diameter = focal / 2 * std::abs(z - s) / z * focal / s / sensor * 1080;
        EXPECT_LE(largest, 0.5 * diameter + 1e-7) << z;
        EXPECT_GE(largest, 0.5 * diameter * (1 - 1.5 / n)) << z;
        // Uniform over the disc: the mean square of the distance is half of the largest.
        EXPECT_NEAR(mean, 0.125 * diameter * diameter, 1e-3 * diameter * diameter + 1e-12) << z;
    }
}

TEST(Camera, ApertureWithBladesIsAPolygon) {
    for (const int blades : {3, 6}) {
        // Uniform: the second moment of a regular polygon with corners at 1 is (2 + cos w) / 6 of
        // the square of its radius, w the angle of a side.
        double square = 0, x = 0, y = 0;
        const int n = 512;
        for (int i = 0; i < n * n; ++i) {
            const Vec2d at = aperture_point(
                {(static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n},
                blades, 0.3);
            // Inside of every side.
            for (int k = 0; k < blades; ++k) {
                const double normal = 0.3 + (k + 0.5) * 2 * pi / blades;
                EXPECT_LE(at.x * std::cos(normal) + at.y * std::sin(normal),
                          std::cos(pi / blades) + 1e-9);
            }
            square += (at.x * at.x + at.y * at.y) / (n * n);
            x += at.x / (n * n);
            y += at.y / (n * n);
        }
        EXPECT_NEAR(square, (2 + std::cos(2 * pi / blades)) / 6, 1e-3);
        EXPECT_NEAR(x, 0, 1e-3);
        EXPECT_NEAR(y, 0, 1e-3);
    }
}

TEST(Camera, FocusTargetIsSharpAndFocusIsGivenOnce) {
    for (const Projection kind : {Projection::Perspective, Projection::Orthographic}) {
        CameraParams p = looking_north();
        p.projection = kind;
        p.lens_radius = 0.2;
        p.focus_target = Keyed<Vec3d>(Vec3d{1.3, -1, 2.2});
        const Camera camera(p, 0, 100, 100);
        EXPECT_NEAR(camera.focus_distance(), 3, 1e-12);
        const auto at = camera.project({1.3, -1, 2.2});
        for (const Vec2f u : {Vec2f{0.1f, 0.9f}, Vec2f{0.99f, 0.5f}}) {
            const Ray ray = camera.ray(at->x, at->y, u);
            const double t = dot(Vec3d(1.3, -1, 2.2) - ray.origin, ray.direction);
            EXPECT_NEAR(length(ray.at(t) - Vec3d(1.3, -1, 2.2)), 0, 1e-12);
            EXPECT_GT(length(ray.origin - camera.ray(at->x, at->y).origin), 0.1);
        }
        CameraParams twice = p;
        twice.focus_distance = Keyed<double>(3.0);
        EXPECT_THROW(Camera(twice, 0, 10, 10), Error);
        twice = p;
        twice.f_number = 2.0;
        EXPECT_THROW(Camera(twice, 0, 10, 10), Error);
        p.focus_target = Keyed<Vec3d>(Vec3d{1, -5, 2});
        EXPECT_THROW(Camera(p, 0, 10, 10), Error);
    }
}

// A pan and a dolly while the shutter is open: at each moment the rays are those of a camera that
// was made for it.
TEST(Camera, MovesWhileTheShutterIsOpen) {
    CameraParams p = looking_north();
    p.position = Keyed<Vec3d>({0, 1}, {Vec3d{1, -4, 2}, Vec3d{3, -5, 2}});
    p.target = Keyed<Vec3d>({0, 1}, {Vec3d{1, 0, 2}, Vec3d{0, 0, 3}});
    p.fov_degrees = Keyed<double>({0, 1}, {50, 40});
    const Camera moving(p, 0.5, 320, 180, {0, 0, 1}, 0.5);
    for (const double share : {0.0, 0.2, 0.5, 0.77, 1.0}) {
        const Camera still(p, 0.25 + 0.5 * share, 320, 180);
        const Ray a = moving.ray(17, 160, {}, share), b = still.ray(17, 160);
        EXPECT_NEAR(length(a.origin - b.origin), 0, 1e-9);
        EXPECT_NEAR(length(a.direction - b.direction), 0, 1e-4);
        EXPECT_NEAR(length(a.direction), 1, 1e-14);
    }
    EXPECT_NEAR(
        length(moving.ray(17, 160).direction - Camera(p, 0.5, 320, 180).ray(17, 160).direction), 0,
        1e-9);
    // Without a shutter it stands still.
    const Camera still(p, 0.5, 320, 180);
    EXPECT_EQ(length(still.ray(17, 160, {}, 0.1).direction - still.ray(17, 160).direction), 0);
}

}  // namespace
}  // namespace gischt
