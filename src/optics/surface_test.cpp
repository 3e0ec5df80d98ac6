// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "optics/surface_params.h"
#include "optics/surface_rig.h"
#include "shape/mesh.h"

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

// A ball of triangles in the place of a sphere: the same hits to the order of its edges, the same
// shading normals by far better, front and back, whatever the file's up axis.
TEST(Surface, MeshesStandWhereTheyShould) {
    MeshSurface mesh;
    mesh.file = "ball";
    mesh.translate = Keyed<Vec3d>(Vec3d{1, 2, 3});
    mesh.scale = Keyed<double>(2);
    mesh.smooth_degrees = 60;
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d{1, 2, 3});
    ball.radius = 2;
    Job job;
    const auto load = [](const std::string&, Job&) { return ball_mesh(1, 4); };
    const SurfaceSet triangles = SurfaceRig({mesh}, {}, {0, 0, 1}, load, {}, job).at(0, 0, {}),
                     exact({ball}, 0);
    for (std::uint32_t i = 0; i < 300; ++i) {
        const std::uint64_t key = random_key(1, i);
        const auto u = [&](std::uint32_t d) { return 2.0 * random_uniform(key, d) - 1; };
        const Vec3d d = normalize(Vec3d{u(0), u(1), u(2)}),
                    aim = Vec3d{1, 2, 3} + Vec3d{u(3), u(4), u(5)};
        for (const double back : {6.0, 0.0}) {
            const auto a = triangles.intersect(along(aim - back * d, d)),
                       b = exact.intersect(along(aim - back * d, d));
            ASSERT_TRUE(a && b);
            ASSERT_NEAR(length(a->point - b->point), 0, 0.02);
            ASSERT_EQ(a->front, back > 0);
            ASSERT_LT(dot(a->normal, d), 0);
            ASSERT_GT(dot(a->shading_normal, b->normal), 0.9995);
            ASSERT_TRUE(triangles.is_blocked(along(aim - back * d, d)));
        }
    }
    EXPECT_NEAR(triangles.bounds().hi.z, 5, 0.02);
}

// Light rays that leave a mesh on either side go on without hitting where they left.
TEST(Surface, RaysLeaveMeshesOnBothSides) {
    MeshSurface mesh;
    mesh.file = "ball";
    mesh.translate = Keyed<Vec3d>(Vec3d{100, 20, -40});
    Job job;
    const auto load = [](const std::string&, Job&) { return ball_mesh(1, 2); };
    const SurfaceSet set = SurfaceRig({mesh}, {}, {0, 0, 1}, load, {}, job).at(0, 0, {});
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const std::uint64_t key = random_key(2, i);
        const auto u = [&](std::uint32_t d) { return 2.0 * random_uniform(key, d) - 1; };
        const Vec3d d = normalize(Vec3d{u(0), u(1), u(2)});
        const auto hit = set.intersect(along(Vec3d{100, 20, -40} - 3.0 * d, d));
        ASSERT_TRUE(hit && hit->front);
        // Onwards: through the ball to its other side, and then out.
        const auto far = set.intersect(leaving_ray(*hit, d));
        ASSERT_TRUE(far && !far->front);
        ASSERT_GT(far->t, 1);
        ASSERT_FALSE(set.intersect(leaving_ray(*far, d)));
        // Back again, close to the surface too.
        const Vec3d away = normalize(hit->normal + 0.999 * normalize(cross(hit->normal, d)));
        ASSERT_FALSE(set.is_blocked(leaving_ray(*hit, away)));
    }
}

// Points with velocities and keyed placements move while the film is exposed.
TEST(Surface, MeshesMoveThroughTheShutter) {
    MeshSurface keyed, flowing;
    keyed.file = "still";
    keyed.translate = Keyed<Vec3d>({0, 1}, {Vec3d{0, 0, 0}, Vec3d{4, 0, 0}});
    flowing.file = "flowing";
    Job job;
    const auto load = [](const std::string& file, Job&) {
        Mesh mesh = ball_mesh(0.5, 2);
        // Up in the file is y, in the scene z: velocities turn with the points.
        if (file == "flowing") mesh.velocities.assign(mesh.points.size(), Vec3f(4, 0, 0));
        return mesh;
    };
    for (const MeshSurface& mesh : {keyed, flowing}) {
        const double time = mesh.file == "still" ? 0.5 : 0;
        const double middle = mesh.file == "still" ? 2 : 0;
        SurfaceRig rig({mesh}, {}, {0, 0, 1}, load, {}, job);
        const SurfaceSet set = rig.at(time, 1, {});
        EXPECT_TRUE(set.info(0).is_moving);
        for (const float moment : {0.0f, 0.25f, 1.0f}) {
            const double place = middle + 4 * (static_cast<double>(moment) - 0.5);
            EXPECT_TRUE(set.intersect(along({place + 0.4, 0.05, 3}, {0, 0, -1}), moment));
            EXPECT_FALSE(set.intersect(along({place + 0.6, 0.05, 3}, {0, 0, -1}), moment));
            EXPECT_FALSE(set.is_blocked(along({place - 0.6, 0.05, 3}, {0, 0, -1}), moment));
        }
        EXPECT_FALSE(rig.at(time, 0, {}).info(0).is_moving);
    }
}

// What the file says counts where the scene says nothing.
TEST(Surface, MeshesTakeTheColorOfTheirFile) {
    MeshSurface mesh;
    mesh.file = "red";
    Job job;
    const auto load = [](const std::string&, Job&) {
        return SurfaceRig::ColoredMesh(cube_mesh(), Vec3f(0.9f, 0.2f, 0.1f));
    };
    const auto albedo = [&] {
        const SurfaceSet set = SurfaceRig({mesh}, {}, {0, 0, 1}, load, {}, job).at(0, 0, {});
        const auto hit = set.intersect(along({0.3, 0.4, 5}, {0, 0, -1}), 0.5f);
        return set.bsdf(*hit).albedo_estimate({0, 0, 1});
    };
    EXPECT_NEAR(albedo().x, 0.9f, 1e-6f);
    EXPECT_NEAR(albedo().z, 0.1f, 1e-6f);
    mesh.material.albedo = Vec3d(0.3);
    EXPECT_NEAR(albedo().x, 0.3f, 1e-6f);
}

TEST(Surface, MeshesReportWhatIsWrongWithThem) {
    MeshSurface mesh;
    mesh.name = "bowl";
    mesh.file = "broken";
    mesh.material.kind = MaterialKind::Dielectric;
    Job job;
    std::string told;
    job.on_message = [&](Job::Level, std::string_view text) { told += text; };
    const auto load = [](const std::string&, Job&) {
        Mesh m = cube_mesh();
        m.triangles[0] = {1, 1, 2};
        return m;
    };
    SurfaceRig({mesh}, {}, {0, 0, 1}, load, {}, job);
    EXPECT_NE(told.find("solid 'bowl': 1 triangles dropped: 1 without area"), told.npos) << told;
    EXPECT_NE(told.find("not closed"), told.npos) << told;
    const auto load_nothing = [](const std::string&, Job&) { return Mesh{}; };
    EXPECT_THROW(SurfaceRig({mesh}, {}, {0, 0, 1}, load_nothing, {}, job), Error);
    EXPECT_THROW(SurfaceSet({mesh}, 0), Error);
    mesh.material.interior = "smoke";
    SurfaceRig rig({mesh}, {}, {0, 0, 1}, load, {}, job);
    EXPECT_THROW(rig.at(0, 0, {{"steam", nullptr}}), Error);
}

// A picture lies on the ground in metres, repeats, and multiplies the albedo.
TEST(Surface, TexturesLieOnSurfaces) {
    GroundSurface ground;
    ground.material.albedo = {0.5, 0.5, 0.5};
    ground.material.texture = TextureParams{"four pixels", {0.5, 0.5}};
    const auto load = [](const std::string&) {
        Image image = Image::rgb(2, 2);
        const auto [r, g, b] = image.color();
        // Top row red, green; bottom row blue, white.
        const float red[] = {1, 0, 0, 1}, green[] = {0, 1, 0, 1}, blue[] = {0, 0, 1, 1};
        for (std::size_t i = 0; i < 4; ++i) r[i] = red[i], g[i] = green[i], b[i] = blue[i];
        return image;
    };
    Job job;
    SurfaceRig rig({ground}, {}, {0, 0, 1}, {}, load, job);
    const SurfaceSet set = rig.at(0, 0, {});
    const auto color = [&](double x, double y) {
        return set.intersect(along({x, y, 3}, {0, 0, -1}))->albedo;
    };
    const auto expect = [&](const Vec3f& a, const Vec3f& b) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6);
    };
    for (const double period : {0.0, 2.0, -6.0}) {
        expect(color(0.5 + period, 1.5), {0.5f, 0, 0});
        expect(color(1.5, 1.5 + period), {0, 0.5f, 0});
        expect(color(0.5 + period, 0.5), {0, 0, 0.5f});
        // Between all four.
        expect(color(1 + period, 1), {0.25f, 0.25f, 0.25f});
    }
    EXPECT_THROW(SurfaceSet({ground}, 0), Error);
}

// Smooth glass and rough metal, whatever the surface: the scattering functions fit their materials
// and the side that is hit.
TEST(Surface, MaterialsMakeTheirScattering) {
    SphereSurface ball;
    ball.material.kind = MaterialKind::Dielectric;
    ball.material.ior = 1.33;
    const SurfaceSet glass({ball}, 0);
    const auto refracted_sine = [](const SurfaceSet& set, const Ray& ray, double ior) {
        const auto hit = set.intersect(ray);
        const auto s = set.bsdf(*hit, ior).sample(-ray.direction, {0.5f, 0.5f}, 0.9999f);
        EXPECT_TRUE(s && s->is_transmission);
        return length(cross(s->direction, hit->normal)) / length(cross(ray.direction, hit->normal));
    };
    const Ray in = along({-3, 0, 0.5}, {1, 0, 0}), out = along({0, 0, 0.5}, {1, 0, 0});
    EXPECT_NEAR(refracted_sine(glass, in, 0), 1 / 1.33, 1e-9);
    EXPECT_NEAR(refracted_sine(glass, out, 0), 1.33, 1e-9);
    EXPECT_NEAR(refracted_sine(glass, out, 0.9), 1 / 0.9, 1e-9);

    ball.material.kind = MaterialKind::Conductor;
    ball.material.metal = Metal::Gold;
    ball.material.roughness = 0.5;
    const SurfaceSet gold({ball}, 0);
    const auto hit = gold.intersect(in);
    const Bsdf bsdf = gold.bsdf(*hit);
    EXPECT_FALSE(bsdf.is_delta_only());
    const auto s = bsdf.sample(-in.direction, {0.1f, 0.2f}, 0.5f);
    ASSERT_TRUE(s);
    EXPECT_GT(s->weight.x, 2 * s->weight.z);
    ball.material.kind = MaterialKind::None;
    EXPECT_FALSE(SurfaceSet({ball}, 0).is_blocked(in));
}

TEST(Surface, ContradictionsAreRefused) {
    const auto fails = [](const char* key, Value value, const char* material) {
        Value table;
        table.set("type", "sphere");
        table.set("material", material);
        table.set(key, std::move(value));
        try {
            read(table, surface_variants());
        } catch (const Error& e) {
            return e.kind() == ErrorKind::Usage;
        }
        return false;
    };
    EXPECT_TRUE(fails("metal", "gold", "plastic"));
    EXPECT_FALSE(fails("metal", "gold", "conductor"));
    EXPECT_TRUE(fails("interior", "smoke", "lambert"));
    EXPECT_FALSE(fails("interior", "smoke", "none"));
    EXPECT_TRUE(fails("color", 0.5, "lambert"));
    EXPECT_TRUE(fails("ior", 0.5, "dielectric"));
    EXPECT_TRUE(fails("roughness", 1.5, "conductor"));
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
