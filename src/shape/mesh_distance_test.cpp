// SPDX-License-Identifier: Apache-2.0
#include "shape/mesh_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "shape/shape.h"

namespace gischt {
namespace {

double signed_by_mesh(const MeshDistance& mesh, const Vec3d& p) {
    return mesh.is_inside(p) ? -mesh.distance(p) : mesh.distance(p);
}

Vec3d random_point(int i, double half) {
    const auto at = [&](int axis) {
        const auto bits = random_key(7, static_cast<std::uint64_t>(i), std::uint64_t(axis)) >> 11;
        return half * (2 * std::ldexp(static_cast<double>(bits), -53) - 1);
    };
    return {at(0), at(1), at(2)};
}

TEST(MeshDistance, OfACubeIsThatOfTheBox) {
    const MeshDistance mesh(cube_mesh());
    const SolidBox box{};
    for (int i = 0; i < 4000; ++i) {
        const Vec3d p = random_point(i, 1.5);
        ASSERT_NEAR(signed_by_mesh(mesh, p), signed_distance(box, p), 1e-7);
    }
}

// The mesh lies between the ball of its radius and the one that touches its faces in the middle.
TEST(MeshDistance, OfABallIsThatOfTheSphereWithinItsFacets) {
    constexpr double radius = 2;
    double last = 0;
    for (int level = 2; level < 6; ++level) {
        const Mesh ball = ball_mesh(radius, level);
        double sagitta = 0;
        for (const Vec3i& t : ball.triangles) {
            const auto at = [&](int k) { return Vec3d(ball.points[std::size_t(k)]); };
            sagitta = std::max(sagitta, radius - length(at(t.x) + at(t.y) + at(t.z)) / 3);
        }
        const MeshDistance mesh(ball);
        double worst = 0;
        for (int i = 0; i < 1000; ++i) {
            const Vec3d p = random_point(i, 3);
            worst = std::max(worst, std::abs(signed_by_mesh(mesh, p) - (length(p) - radius)));
        }
        EXPECT_LT(worst, 1.01 * sagitta + 1e-6);
        EXPECT_GT(worst, 0.3 * sagitta);
        if (last > 0) {
            EXPECT_NEAR(last / worst, 4, 0.6);  // second order in the edges
        }
        last = worst;
    }
}

TEST(MeshDistance, StopsAtTheLimit) {
    const MeshDistance mesh(ball_mesh(1, 3));
    EXPECT_EQ(mesh.distance({5, 0, 0}, 0.5), 0.5);
    EXPECT_NEAR(mesh.distance({1.25, 0, 0}, 0.5), 0.25, 0.01);
}

// A mesh that is turned inside out, and one whose parts overlap, have the same inside.
TEST(MeshDistance, TellsInsideWhateverTheTurnAndOverlap) {
    Mesh mesh = ball_mesh(1, 3);
    const MeshDistance one(mesh);
    Mesh turned = mesh;
    for (Vec3i& t : turned.triangles) std::swap(t.y, t.z);
    const MeshDistance other(turned);
    Mesh two = mesh;
    const int count = static_cast<int>(mesh.points.size());
    for (const Vec3f& p : mesh.points) two.points.push_back(p + Vec3f(0.8f, 0, 0));
    for (const Vec3i& t : mesh.triangles) two.triangles.push_back(t + Vec3i(count));
    const MeshDistance both(two);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d p = random_point(i, 1.7);
        ASSERT_EQ(one.is_inside(p), other.is_inside(p));
        ASSERT_EQ(both.is_inside(p), one.is_inside(p) || one.is_inside(p - Vec3d(0.8, 0, 0)));
    }
}

TEST(MeshDistance, RefusesWhatHasNoInside) {
    EXPECT_THROW(MeshDistance(Mesh{}), Error);
    Mesh open = ball_mesh(1, 2);
    open.triangles.pop_back();
    EXPECT_THROW(MeshDistance{open}, Error);
    Mesh broken = ball_mesh(1, 2);
    broken.points[3].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(MeshDistance{broken}, Error);
    broken = ball_mesh(1, 2);
    broken.triangles[3].x = 1 << 30;
    EXPECT_THROW(MeshDistance{broken}, Error);
}

}  // namespace
}  // namespace gischt
