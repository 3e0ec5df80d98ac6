// SPDX-License-Identifier: Apache-2.0
#include "shape/embree_scene.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/random.h"
#include "shape/mesh.h"

namespace gischt {
namespace {

TriangleObject object_of(const Mesh& mesh, const Vec3d& move = {}) {
    TriangleObject o;
    for (const Vec3f& p : mesh.points) o.points.push_back(Vec3d(p) + move);
    o.triangles = mesh.triangles;
    return o;
}

Vec3d random_vector(std::uint64_t key, std::uint32_t first) {
    const auto u = [&](std::uint32_t d) { return 2.0 * random_uniform(key, first + d) - 1; };
    return {u(0), u(1), u(2)};
}

// Triangles of all sizes and slimnesses, far from the origin.
TriangleObject soup(int count, const Vec3d& place) {
    TriangleObject o;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t key = random_key(7, static_cast<std::uint64_t>(i));
        const double size = std::pow(10.0, -3.0 * random_uniform(key, 20));
        const Vec3d center = place + random_vector(key, 0), a = size * random_vector(key, 3);
        const double slim = std::pow(10.0, -3.0 * random_uniform(key, 21));
        o.points.push_back(center - a);
        o.points.push_back(center + a);
        o.points.push_back(center + slim * size * random_vector(key, 6));
        o.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return o;
}

// No ray from inside slips out of a closed mesh, not through edges either.
TEST(EmbreeScene, IsWatertight) {
    const Vec3d place{100, -50, 30};
    const Mesh ball = ball_mesh(1, 3);
    const EmbreeScene scene({object_of(ball, place)});
    int missed = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const std::uint64_t key = random_key(1, i);
        const Vec3d from = place + 0.5 * random_vector(key, 0);
        const Vec3i& t = ball.triangles[i % ball.triangles.size()];
        const Vec3d a = Vec3d(ball.points[std::size_t(t.x)]) + place,
                    b = Vec3d(ball.points[std::size_t(t.y)]) + place;
        const Vec3d aim = i % 2 == 0 ? from + random_vector(key, 5)
                                     : a + static_cast<double>(random_uniform(key, 9)) * (b - a);
        const Ray ray{from, aim - from};
        const auto hit = scene.intersect(ray);
        missed += !hit;
        if (!hit) continue;
        // The point lies on the mesh and on the ray, whose length is any.
        ASSERT_NEAR(length(hit->point - ray.at(hit->t)), 0, 2e-6);
        ASSERT_GT(dot(hit->normal, hit->point - place), 0.9);
        ASSERT_TRUE(scene.is_blocked(ray));
        Ray shorter = ray;
        shorter.t_max = 0.99 * hit->t;
        ASSERT_FALSE(scene.is_blocked(shorter));
    }
    EXPECT_EQ(missed, 0);
}

// The nearest hit against a search through all triangles in double (Moeller & Trumbore 1997).
TEST(EmbreeScene, FindsTheNearest) {
    const TriangleObject o = soup(300, {3, 4, 5});
    const EmbreeScene scene({o});
    int hits = 0, different = 0;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const std::uint64_t key = random_key(2, i);
        const Ray ray{Vec3d{3, 4, 5} + 2.0 * random_vector(key, 0), random_vector(key, 3)};
        double nearest = 1e300;
        int which = -1;
        for (std::size_t k = 0; k < o.triangles.size(); ++k) {
            const Vec3d &a = o.points[3 * k], e1 = o.points[3 * k + 1] - a,
                        e2 = o.points[3 * k + 2] - a, p = cross(ray.direction, e2),
                        s = ray.origin - a, q = cross(s, e1);
            const double det = dot(e1, p), u = dot(s, p) / det, v = dot(ray.direction, q) / det,
                         t = dot(e2, q) / det;
            if (u < 0 || v < 0 || u + v > 1 || !(t > 0) || t >= nearest) continue;
            nearest = t;
            which = static_cast<int>(k);
        }
        const auto hit = scene.intersect(ray);
        hits += which >= 0;
        // At the very edges rounding decides.
        if (hit.has_value() != (which >= 0) || (hit && hit->triangle != which)) {
            ++different;
        } else if (hit) {
            ASSERT_NEAR(hit->t, nearest, 1e-5);
        }
    }
    EXPECT_GT(hits, 100);
    EXPECT_LE(different, 3);
}

// A ray that starts at the offset leaves, to both sides and in any direction, and meets the
// triangle when it turns back.
TEST(EmbreeScene, OffsetsLeaveTheTriangle) {
    for (const double far : {0.0, 10.0, 1e4}) {
        const TriangleObject o = soup(200, {far, -far, 2 * far});
        const EmbreeScene scene({o});
        int tests = 0;
        double largest = 0;
        for (std::uint32_t i = 0; i < 20000; ++i) {
            const std::uint64_t key = random_key(3, i);
            const auto k = static_cast<std::size_t>(i % 200);
            const Vec3d aim =
                o.points[3 * k] * 0.4 + o.points[3 * k + 1] * 0.25 + o.points[3 * k + 2] * 0.35;
            const Vec3d from = aim + random_vector(key, 0);
            const auto hit = scene.intersect({from, aim - from});
            if (!hit) continue;
            // Of triangles that are not slim: an offset is not a visible gap.
            const Vec3d e = o.points[3 * k + 1] - o.points[3 * k];
            const double height =
                length(cross(e, o.points[3 * k + 2] - o.points[3 * k])) / length(e);
            if (height > 0.1 * length(e)) largest = std::max(largest, hit->offset);
            for (const double side : {-1.0, 1.0}) {
                Vec3d away = normalize(random_vector(key, 6));
                if (dot(away, hit->normal) * side < 0) away = -away;
                const Ray ray{hit->point + side * hit->offset * hit->normal, away};
                for (const TriangleHit& again : scene.all_hits(ray)) {
                    ASSERT_NE(again.triangle, hit->triangle);
                }
                ++tests;
            }
        }
        EXPECT_GT(tests, 5000);
        EXPECT_LT(largest, 5e-5);
    }
}

TEST(EmbreeScene, MovesEvenlyBetweenTwoMoments) {
    const Mesh ball = ball_mesh(0.5, 3);
    TriangleObject o = object_of(ball);
    const Vec3d way{2, 0, 0};
    for (const Vec3d& p : o.points) o.points_end.push_back(p + way);
    const EmbreeScene moving({o});
    for (const float moment : {0.0f, 0.3f, 1.0f}) {
        const EmbreeScene still({object_of(ball, static_cast<double>(moment) * way)});
        for (std::uint32_t i = 0; i < 500; ++i) {
            const std::uint64_t key = random_key(4, i);
            const Ray ray{{2 * random_vector(key, 0).x, -3, 0.5 * random_vector(key, 3).z},
                          {0, 1, 0}};
            const auto a = moving.intersect(ray, moment), b = still.intersect(ray);
            ASSERT_EQ(a.has_value(), b.has_value());
            if (a) {
                ASSERT_NEAR(a->t, b->t, 1e-5);
            }
        }
    }
    EXPECT_EQ(moving.bounds().hi.x, 2.5);
}

TEST(EmbreeScene, AllHitsEnterAndLeaveInTurn) {
    TriangleObject inner = object_of(ball_mesh(0.5, 2)), outer = object_of(ball_mesh(1, 3));
    inner.bits = 1;
    const EmbreeScene scene({inner, outer});
    for (std::uint32_t i = 0; i < 500; ++i) {
        const Vec3d d = random_vector(random_key(5, i), 0);
        const auto hits = scene.all_hits({-3.0 * normalize(d), d});
        ASSERT_EQ(hits.size(), 4u);
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(hits[k].object, k == 0 || k == 3 ? 1 : 0);
            ASSERT_EQ(dot(hits[k].normal, d) < 0, k < 2);
        }
        // From the centre, past the inner ball.
        ASSERT_EQ(scene.intersect({{}, d})->object, 0);
        ASSERT_EQ(scene.intersect({{}, d}, 0, 1)->object, 1);
        const Ray near{{}, normalize(d), 0, 0.7};
        ASSERT_TRUE(scene.is_blocked(near));
        ASSERT_FALSE(scene.is_blocked(near, 0, 1));
    }
}

// A camera a million metres away sees the same as one close by.
TEST(EmbreeScene, FarOriginsKeepTheirDigits) {
    const EmbreeScene scene({object_of(ball_mesh(1, 4))});
    for (std::uint32_t i = 0; i < 200; ++i) {
        const Vec3d d = normalize(random_vector(random_key(6, i), 0));
        const auto near = scene.intersect({-2.0 * d, d}), far = scene.intersect({-1e6 * d, d});
        ASSERT_TRUE(near && far);
        ASSERT_NEAR(length(near->point - far->point), 0, 1e-6);
    }
}

TEST(EmbreeScene, DegenerateInputIsHarmless) {
    EXPECT_TRUE(EmbreeScene(std::vector<TriangleObject>{}).is_empty());
    EXPECT_FALSE(EmbreeScene(std::vector<TriangleObject>(1)).intersect({{}, {1, 0, 0}}));
    // A flat mesh, a triangle of no area, a ray of no direction.
    TriangleObject flat;
    flat.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    flat.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 1, 1}};
    const EmbreeScene scene({flat});
    EXPECT_TRUE(scene.intersect({{0.2, 0.3, 1}, {0, 0, -1}}));
    EXPECT_FALSE(scene.intersect({{0.2, 0.3, 1}, {0, 0, 0}}));
    EXPECT_FALSE(scene.intersect({{0.2, 0.3, 1}, {0, 0, -1}, 0, 0.5}));
    EXPECT_FALSE(scene.intersect({{0.2, 0.3, 1}, {0, 0, -1}, 1.5, 9}));
}

}  // namespace
}  // namespace gischt
