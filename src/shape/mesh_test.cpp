// SPDX-License-Identifier: Apache-2.0
#include "shape/mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/units.h"

namespace gischt {
namespace {

TEST(Mesh, CubeAndBallEncloseTheirVolume) {
    EXPECT_TRUE(is_closed(cube_mesh()));
    EXPECT_NEAR(enclosed_volume(cube_mesh()), 1, 1e-12);
    EXPECT_NEAR(surface_area(cube_mesh()), 6, 1e-12);
    double last = 1;
    for (int level = 1; level < 5; ++level) {
        const Mesh ball = ball_mesh(2, level);
        EXPECT_EQ(ball.triangles.size(), 20u << 2 * level);
        EXPECT_TRUE(is_closed(ball));
        // The volume converges from below with the square of the edge.
        const double missing = 1 - enclosed_volume(ball) / (4.0 / 3 * pi * 8);
        EXPECT_GT(missing, 0);
        if (level > 1) {
            EXPECT_NEAR(last / missing, 4, 0.4);
        }
        last = missing;
    }
}

TEST(Mesh, OpenAndTwistedMeshesAreNotClosed) {
    Mesh open = cube_mesh();
    open.triangles.pop_back();
    EXPECT_FALSE(is_closed(open));
    Mesh twisted = cube_mesh();
    std::swap(twisted.triangles[0].x, twisted.triangles[0].y);
    EXPECT_FALSE(is_closed(twisted));
    EXPECT_FALSE(is_closed(Mesh{}));
    // Points that are split, as at a seam, do not open it.
    Mesh split = cube_mesh();
    split.points.push_back(split.points[std::size_t(split.triangles[3].x)]);
    split.triangles[3].x = 8;
    EXPECT_TRUE(is_closed(split));
}

TEST(Mesh, MirroringKeepsOutsideOutside) {
    Transform map = Transform::rotation(normalize(Vec3d{1, 2, 3}), 0.7);
    map.column[1] = -2.0 * map.column[1];
    map.translation = {5, 6, 7};
    const Mesh ball = transformed(with_smooth_normals(ball_mesh(1, 2), 180), map);
    EXPECT_NEAR(enclosed_volume(ball), 2 * enclosed_volume(ball_mesh(1, 2)), 1e-4);
    for (const Vec3i& t : ball.triangles) {
        const auto p = [&](int i) { return Vec3d(ball.points[std::size_t(i)]); };
        const Vec3d face = cross(p(t.y) - p(t.x), p(t.z) - p(t.x));
        ASSERT_GT(dot(face, Vec3d(ball.normals[std::size_t(t.x)])), 0);
    }
}

TEST(Mesh, FaultsAreDroppedAndCounted) {
    Mesh mesh = cube_mesh();
    mesh.points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
    mesh.triangles.emplace_back(0, 1, 8);
    mesh.triangles.emplace_back(0, 1, 9);
    mesh.triangles.emplace_back(-1, 1, 2);
    mesh.triangles.emplace_back(3, 3, 4);
    const MeshFaults faults = remove_faults(mesh);
    EXPECT_EQ(faults.not_finite, 1);
    EXPECT_EQ(faults.no_point, 2);
    EXPECT_EQ(faults.flat, 1);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_TRUE(is_closed(mesh));
}

// Whatever the polygon, its triangles have its area and lie within: a star of ten corners and a
// comb, which a fan would get wrong.
TEST(Mesh, PolygonsAreCutWithinThemselves) {
    const auto expect_area = [](const std::vector<Vec3f>& points, double area) {
        Mesh mesh;
        mesh.points = points;
        std::vector<int> corners;
        for (std::size_t i = 0; i < points.size(); ++i) corners.push_back(static_cast<int>(i));
        ASSERT_TRUE(add_polygon(mesh, corners));
        EXPECT_EQ(mesh.triangles.size(), points.size() - 2);
        EXPECT_NEAR(surface_area(mesh), area, 1e-5);
    };
    std::vector<Vec3f> star, comb{{0, 0, 0}, {9, 0, 0}};
    double area = 0;
    for (int i = 0; i < 10; ++i) {
        const double r = i % 2 ? 0.4 : 1, a = 2 * pi * i / 10;
        star.emplace_back(Vec3d{r * std::cos(a), r * std::sin(a), 2});
        area += 0.5 * 0.4 * std::sin(2 * pi / 10);
    }
    expect_area(star, area);
    for (int i = 8; i >= 0; --i)
        comb.emplace_back(static_cast<float>(i), i % 2 ? 5.0f : 1.0f, 0.0f);
    double comb_area = 0;
    for (std::size_t i = 0; i < comb.size(); ++i) {
        const Vec3f &p = comb[i], q = comb[(i + 1) % comb.size()];
        comb_area += 0.5 * static_cast<double>(p.x * q.y - p.y * q.x);
    }
    expect_area(comb, comb_area);
}

// Normals of a fine ball are those of the sphere to the order of the edge; a cube stays flat below
// 90 degrees and is round above.
TEST(Mesh, NormalsAreSmoothUpToTheCrease) {
    const Mesh ball = with_smooth_normals(ball_mesh(1, 4), 30);
    EXPECT_EQ(ball.points.size(), ball_mesh(1, 4).points.size());
    for (std::size_t i = 0; i < ball.points.size(); ++i) {
        ASSERT_GT(dot(Vec3d(ball.normals[i]), Vec3d(ball.points[i])), 0.9999);
    }
    const Mesh flat = with_smooth_normals(cube_mesh(), 80);
    EXPECT_EQ(flat.points.size(), 24u);
    for (const Vec3f& n : flat.normals) EXPECT_NEAR(max_component(abs(n)), 1, 1e-6);
    const Mesh round = with_smooth_normals(cube_mesh(), 100);
    EXPECT_EQ(round.points.size(), 8u);
    // Weighted by angle, all three faces count the same at each corner.
    for (const Vec3f& n : round.normals) EXPECT_NEAR(std::abs(n.x), std::sqrt(1.0f / 3), 1e-6);
}

}  // namespace
}  // namespace gischt
