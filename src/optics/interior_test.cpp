// SPDX-License-Identifier: Apache-2.0
#include "optics/interior.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "optics/medium.h"
#include "optics/surface_params.h"
#include "optics/surface_rig.h"

namespace gischt {
namespace {

SphereSurface ball(const Vec3d& center, double radius, double ior, int priority = 0) {
    SphereSurface s;
    s.center = Keyed<Vec3d>(center);
    s.radius = radius;
    s.material.kind = MaterialKind::Dielectric;
    s.material.ior = ior;
    s.material.priority = priority;
    return s;
}

// The relative indices of the true boundaries along a straight line, false ones passed.
std::vector<double> boundaries(const SurfaceSet& set, Ray ray) {
    InteriorStack interiors(set, ray.origin);
    std::vector<double> found;
    for (int i = 0; i < 100; ++i) {
        const auto hit = set.intersect(ray);
        if (!hit) break;
        const auto crossing = interiors.at(*hit);
        if (!crossing.is_false) found.push_back(crossing.relative_ior);
        interiors.cross(*hit);
        ray = leaving_ray(*hit, ray.direction);
    }
    EXPECT_EQ(interiors.surface(), -1);
    EXPECT_EQ(interiors.ior(), 1);
    return found;
}

constexpr Vec3d x{1, 0, 0};

TEST(Interior, AGlassInAir) {
    const SurfaceSet set({ball({}, 1, 1.5)}, 0);
    EXPECT_EQ(boundaries(set, {{-3, 0, 0}, x}), (std::vector<double>{1.5, 1 / 1.5}));
    // A camera inside knows where it is.
    EXPECT_EQ(boundaries(set, {{0, 0.5, 0}, x}), (std::vector<double>{1 / 1.5}));
}

// A marble of glass in water: water to glass and back, in whatever order the scene has them, by
// priority or by being inside.
TEST(Interior, GlassWithinWater) {
    const std::vector<double> expected{1.33, 1.5 / 1.33, 1.33 / 1.5, 1 / 1.33};
    for (const int priority : {0, 1}) {
        const auto glass = ball({}, 1, 1.5, priority), water = ball({}, 2, 1.33);
        for (const std::vector<SurfaceParams>& order :
             {std::vector<SurfaceParams>{glass, water}, {water, glass}}) {
            const auto found = boundaries(SurfaceSet(order, 0), {{-3, 0.1, 0}, x});
            ASSERT_EQ(found.size(), 4u);
            for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i], 1e-12);
        }
    }
    // With the water above all, the glass within is nothing.
    const SurfaceSet drowned({ball({}, 1, 1.5, 1), ball({}, 2, 1.33, 2)}, 0);
    EXPECT_EQ(boundaries(drowned, {{-3, 0.1, 0}, x}), (std::vector<double>{1.33, 1 / 1.33}));
}

// Water that reaches a little into its glass: air, glass, water, glass, air, from both sides.
TEST(Interior, OverlapsFollowPriorities) {
    const SurfaceSet set({ball({-1, 0, 0}, 1.2, 1.5, 2), ball({1, 0, 0}, 1.2, 1.33, 1)}, 0);
    const auto right = boundaries(set, {{-5, 0, 0}, x}), left = boundaries(set, {{5, 0, 0}, -x});
    const std::vector<double> expected{1.5, 1.33 / 1.5, 1 / 1.33};
    ASSERT_EQ(right.size(), 3u);
    ASSERT_EQ(left.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(right[i], expected[i], 1e-12);
        EXPECT_NEAR(left[i], 1 / expected[2 - i], 1e-12);
    }
}

// Along any line through many overlapping balls the path reversed meets the same true boundaries,
// if all priorities differ; the relative indices multiply to 1.
TEST(Interior, WaysBackMeetTheSameBoundaries) {
    std::vector<SurfaceParams> balls;
    for (int i = 0; i < 8; ++i) {
        const std::uint64_t key = random_key(3, static_cast<std::uint64_t>(i));
        const auto u = [&](std::uint32_t d) { return 2.0 * random_uniform(key, d) - 1; };
        balls.push_back(ball({u(0), u(1), u(2)}, 0.6 + 0.5 * u(3), 1.1 + 0.1 * i, 3 * i % 8));
    }
    const SurfaceSet set(balls, 0);
    int total = 0;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const std::uint64_t key = random_key(4, i);
        const auto u = [&](std::uint32_t d) { return 2.0 * random_uniform(key, d) - 1; };
        const Vec3d d = normalize(Vec3d{u(0), u(1), u(2)}), aim{u(3), u(4), u(5)};
        auto there = boundaries(set, {aim - 9.0 * d, d});
        const auto back = boundaries(set, {aim + 9.0 * d, -d});
        ASSERT_EQ(there.size(), back.size());
        double product = 1;
        for (std::size_t k = 0; k < there.size(); ++k) {
            ASSERT_NEAR(there[k] * back[back.size() - 1 - k], 1, 1e-12);
            product *= there[k];
        }
        ASSERT_NEAR(product, 1, 1e-12);
        total += static_cast<int>(there.size());
    }
    EXPECT_GT(total, 1000);
}

// Which media surround a point: of the glass, of the boundary around it that has no surface, and
// none in a hollow glass.
TEST(Interior, MediaFillTheirInsides) {
    SphereSurface fog;
    fog.radius = 3;
    fog.material.kind = MaterialKind::None;
    fog.material.medium.emplace();
    auto glass = ball({}, 1, 1.5);
    auto full = ball({1.5, 0, 0}, 0.4, 1.5);
    full.material.medium.emplace();
    const SurfaceSet set({glass, fog, full}, 0);
    const auto at = [&](double place) { return InteriorStack(set, {place, 0.01, 0}); };
    EXPECT_EQ(at(-4).medium(), nullptr);
    EXPECT_EQ(at(-2).medium(), set.info(1).medium.get());
    EXPECT_EQ(at(-2).ior(), 1);
    EXPECT_EQ(at(0).medium(), nullptr);
    EXPECT_EQ(at(0).surface(), 0);
    EXPECT_EQ(at(1.5).medium(), set.info(2).medium.get());
    EXPECT_TRUE(set.is_interior(set.info(1).medium.get()));
    EXPECT_FALSE(set.is_interior(nullptr));
    // The fog's boundary is passed and changes the medium only.
    InteriorStack path(set);
    const auto hit = set.intersect({{-4, 0, 0}, x});
    EXPECT_TRUE(path.at(*hit).is_false);
    path.cross(*hit);
    EXPECT_EQ(path.medium(), set.info(1).medium.get());
    // A shadow ray is not stopped by it, by glass it is.
    EXPECT_FALSE(set.is_blocked({{-4, 0, 0}, x, 0, 2}));
    EXPECT_TRUE(set.is_blocked({{-4, 0, 0}, x}));
}

TEST(Interior, MeshesKnowTheirInside) {
    MeshSurface glass;
    glass.file = "ball";
    glass.material.kind = MaterialKind::Dielectric;
    auto water = ball({}, 3, 1.33);
    Job job;
    SurfaceRig rig(
        {glass, water}, {}, {0, 0, 1}, [](const std::string&, Job&) { return ball_mesh(1, 3); }, {},
        job);
    const SurfaceSet set = rig.at(0, 0, {});
    for (std::uint32_t i = 0; i < 300; ++i) {
        const std::uint64_t key = random_key(5, i);
        const auto u = [&](std::uint32_t d) { return 8.0 * random_uniform(key, d) - 4; };
        const Vec3d p{u(0), u(1), u(2)};
        const double r = length(p);
        if (std::abs(r - 1) < 0.02) continue;
        ASSERT_EQ(InteriorStack(set, p).surface(), r < 1 ? 0 : r < 3 ? 1 : -1);
        ASSERT_EQ(InteriorStack(set, p).ior(), r < 1 ? 1.5 : r < 3 ? 1.33 : 1);
    }
    const auto found = boundaries(set, {{-5, 0.1, 0.2}, x});
    ASSERT_EQ(found.size(), 4u);
    EXPECT_NEAR(found[1], 1.5 / 1.33, 1e-12);
}

TEST(Interior, TooManyAreRefused) {
    std::vector<SurfaceParams> shells;
    for (int i = 0; i < 20; ++i) shells.push_back(ball({}, 1 + 0.1 * i, 1.5));
    const SurfaceSet set(shells, 0);
    EXPECT_THROW(InteriorStack(set, {}), Error);
}

}  // namespace
}  // namespace gischt
