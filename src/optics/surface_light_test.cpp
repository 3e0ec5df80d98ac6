// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "math/sobol.h"
#include "math/statistics.h"
#include "optics/area_lights.h"
#include "optics/surface_params.h"
#include "optics/surface_rig.h"
#include "optics/test_chi_squared.h"
#include "shape/mesh.h"

namespace gischt {
namespace {

constexpr Vec3d up{0, 0, 1};

SurfaceSet with_emission(SurfaceParams surface, double radiance = 1) {
    std::visit([&](auto& s) { s.material.emission = Keyed<Vec3d>(Vec3d(radiance)); }, surface);
    Job job;
    SurfaceRig rig(
        {surface}, {}, up,
        [](const std::string&, Job&) {
            return transformed(ball_mesh(0.5, 1), Transform::scale_translate(1, {}));
        },
        {}, job);
    return rig.at(0, 0, {});
}

SurfaceParams ball(const Vec3d& center, double radius) {
    SphereSurface s;
    s.center = Keyed<Vec3d>(center);
    s.radius = radius;
    return s;
}
SurfaceParams rectangle(const Vec3d& center, const Vec3d& normal, Vec2d size) {
    RectSurface s;
    s.center = Keyed<Vec3d>(center);
    s.normal = normal;
    s.size = size;
    return s;
}
SurfaceParams disc(const Vec3d& center, const Vec3d& normal, double radius) {
    DiscSurface s;
    s.center = Keyed<Vec3d>(center);
    s.normal = normal;
    s.radius = radius;
    return s;
}
SurfaceParams box(const Vec3d& center, const Vec3d& size) {
    BoxSurface s;
    s.center = Keyed<Vec3d>(center);
    s.size = size;
    s.rotation_degrees = Keyed<Vec3d>(Vec3d{10, 20, 30});
    return s;
}
SurfaceParams mesh(const Vec3d& center) {
    MeshSurface s;
    s.file = "ball";
    s.translate = Keyed<Vec3d>(center);
    return s;
}

std::vector<SurfaceParams> all_kinds() {
    return {ball({0, 0, 2}, 0.7), rectangle({0.3, 0, 1.5}, {0.2, 0.1, -1}, {1, 0.6}),
            disc({0.3, 0, 1.2}, {-0.3, 0.1, -1}, 0.8), box({0, 0.4, 2}, {1, 0.5, 0.8}),
            mesh({0.1, 0.2, 1.4})};
}

// Irradiance of a plane that faces up at the origin, by random samples and a shadow test, against
// a view factor, at 4.1 standard errors: over the dozen uses a family-wise significance of 1e-3.
void expect_irradiance(const SurfaceSet& set, double exact, std::uint64_t seed) {
    ASSERT_EQ(set.lights().size(), 1u);
    const SurfaceLight& light = *set.lights()[0];
    RunningStatistics s;
    for (std::uint64_t i = 0; i < 40000; ++i) {
        const std::uint64_t key = random_key(seed, i);
        const LightSample l = light.sample({}, {random_uniform(key, 0), random_uniform(key, 1)});
        const double cosine = std::max(0.0, l.direction.z);
        const bool is_seen =
            cosine > 0 && l.pdf > 0 && !set.is_blocked({{}, l.direction, 0, l.distance});
        s.add(is_seen ? cosine * static_cast<double>(l.weight.x) : 0);
    }
    EXPECT_NEAR(s.mean, exact, 4.1 * s.standard_error() + 1e-6 * exact);
    EXPECT_LT(s.standard_error(), 0.02 * exact);
}

// Closed forms: a ball of sine s of angular radius at the angle t from the normal gives pi s^2 cos
// t; a disc that faces, pi R^2 / (R^2 + h^2); a rectangle over a corner (Howell, Menguc, Siegel
// 2010, factors B-1 and B-4).
TEST(SurfaceLight, IrradianceIsTheViewFactor) {
    expect_irradiance(with_emission(ball({0, 0, 3}, 1)), pi / 9, 1);
    expect_irradiance(with_emission(ball({2, 0, 2}, 1)), pi / 8 * std::sqrt(0.5), 2);
    expect_irradiance(with_emission(ball({0, 0, 1.001}, 1)), pi / (1.001 * 1.001), 3);
    expect_irradiance(with_emission(disc({0, 0, 2}, {0, 0, -1}, 1.5)), pi * 2.25 / (2.25 + 4), 4);
    expect_irradiance(with_emission(disc({0, 0, 50}, {0, 0, -1}, 1)), pi / 2501, 5);
    const auto corner = [](double a, double b, double h) {
        const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
        return 0.5 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
    };
    expect_irradiance(with_emission(rectangle({0.5, 0.35, 0.4}, {0, 0, -1}, {1, 0.7})),
                      corner(1, 0.7, 0.4), 6);
    expect_irradiance(with_emission(rectangle({0.5, 0.35, 300}, {0, 0, -1}, {1, 0.7})),
                      corner(1, 0.7, 300), 7);
    // Seen from its back a sheet is dark.
    expect_irradiance(with_emission(rectangle({0, 0, 1}, {0, 0, -1}, {2, 2})), 4 * corner(1, 1, 1),
                      8);
    EXPECT_EQ(with_emission(rectangle({0, 0, 1}, {0, 0, 1}, {1, 1}))
                  .lights()[0]
                  ->sample({}, {0.5f, 0.5f})
                  .weight,
              Vec3f(0));
}

// From inside of a box or ball that shines, the irradiance is pi everywhere.
TEST(SurfaceLight, FillsTheHemisphereFromInside) {
    expect_irradiance(with_emission(ball({0.2, 0.3, 0}, 1)), pi, 9);
    expect_irradiance(with_emission(box({0.1, 0, 0.2}, {1, 2, 3})), pi, 10);
}

// A ball of triangles gives nearly the light of the ball; exactly that of its own contour, which
// the box's and the mesh's solid angles tell.
TEST(SurfaceLight, FluenceIsTheSolidAngle) {
    for (const SurfaceParams& surface : all_kinds()) {
        const SurfaceSet set = with_emission(surface);
        const SurfaceLight& light = *set.lights()[0];
        RunningStatistics seen, sampled;
        for (std::uint64_t i = 0; i < 40000; ++i) {
            const std::uint64_t key = random_key(11, i);
            const Vec2f u{random_uniform(key, 0), random_uniform(key, 1)};
            const LightSample l = light.sample({}, u);
            const bool is_free = l.pdf > 0 && !set.is_blocked({{}, l.direction, 0, l.distance});
            sampled.add(is_free ? static_cast<double>(l.weight.x) : 0);
            // Directions over the upper hemisphere, in which all of them lie.
            const double z = static_cast<double>(u.x), turn = 2 * pi * static_cast<double>(u.y);
            const double r = std::sqrt(1 - z * z);
            const auto hit = set.intersect({{}, {r * std::cos(turn), r * std::sin(turn), z}});
            seen.add(hit ? 2 * pi * static_cast<double>(hit->emission.x) : 0);
        }
        const double error = std::hypot(seen.standard_error(), sampled.standard_error());
        EXPECT_NEAR(sampled.mean, seen.mean, 4.1 * error) << surface.index();
        if (!std::holds_alternative<MeshSurface>(surface)) {
            EXPECT_NEAR(static_cast<double>(light.mean_radiance({}).x) * 4 * pi, sampled.mean,
                        4.1 * sampled.standard_error() + 1e-6);
        }
    }
}

// Samples against pdf(), near and far, at a family-wise significance of 1e-3.
TEST(SurfaceLight, SamplersHaveTheirDensity) {
    std::uint64_t seed = 100;
    for (const SurfaceParams& surface : all_kinds()) {
        const SurfaceSet set = with_emission(surface);
        const SurfaceLight& light = *set.lights()[0];
        for (const Vec3d& from : {Vec3d{}, Vec3d{0.2, 0.1, 0.6}}) {
            const bool is_mesh = std::holds_alternative<MeshSurface>(surface);
            if (is_mesh) continue;  // its density jumps at each edge; see below
            const ChiSquared test = chi_squared(
                [&](std::uint64_t key) -> std::optional<Vec3d> {
                    const LightSample s =
                        light.sample(from, {random_uniform(key, 0), random_uniform(key, 1)});
                    return s.pdf > 0 ? std::optional(s.direction) : std::nullopt;
                },
                [&](const Vec3d& d) { return static_cast<double>(light.pdf(from, d)); }, ++seed, 7);
            EXPECT_GT(test.p_value, 1e-3 / 8)
                << surface.index() << ": " << test.statistic << " / " << test.freedom;
        }
    }
}

// What sample() says of a direction is what pdf() and pdf_of_hit() say, near and from afar.
TEST(SurfaceLight, DensitiesAgree) {
    for (const SurfaceParams& surface : all_kinds()) {
        const SurfaceSet set = with_emission(surface);
        const SurfaceLight& light = *set.lights()[0];
        for (const Vec3d& from : {Vec3d{}, Vec3d{0.3, 0.2, -0.1}, Vec3d{5, -400, -3000}}) {
            int agreed = 0;
            for (std::uint32_t i = 0; i < 500; ++i) {
                const LightSample s = light.sample(from, sobol_2d(i, 2));
                if (s.pdf == 0) continue;
                const auto hit = set.intersect({from, s.direction});
                if (!hit) continue;  // at the very rim
                const float pdf = light.pdf_of_hit(from, *hit);
                // Another part of the surface may lie before the point.
                if (hit->t < s.distance * (1 - 1e-5)) continue;
                ASSERT_NEAR(pdf / s.pdf, 1, 1e-3) << surface.index();
                ASSERT_NEAR(light.pdf(from, s.direction) / s.pdf, 1, 1e-3) << surface.index();
                ASSERT_FALSE(set.is_blocked({from, s.direction, 0, s.distance}));
                ++agreed;
            }
            EXPECT_GT(agreed, 100) << surface.index();
        }
    }
}

// A closed mesh: the flux through a far sphere is its power.
TEST(SurfaceLight, PowerIsTheFluxThroughAFarSphere) {
    for (const SurfaceParams& surface : all_kinds()) {
        const SurfaceSet set = with_emission(surface, 3);
        RunningStatistics flux;
        constexpr double r = 1000;
        for (std::uint64_t i = 0; i < 4000; ++i) {
            const std::uint64_t key = random_key(12, i);
            const double z = 2.0 * random_uniform(key, 0) - 1,
                         turn = 2 * pi * random_uniform(key, 1);
            const double s = std::sqrt(1 - z * z);
            const Vec3d n{s * std::cos(turn), s * std::sin(turn), z};
            // A closed mesh shows all its triangles that face the point.
            double fluence = 0;
            constexpr int n_samples = 8;
            for (std::uint32_t k = 0; k < n_samples; ++k) {
                const LightSample l = set.lights()[0]->sample(
                    r * n, {random_uniform(key, 2 + 2 * k), random_uniform(key, 3 + 2 * k)});
                fluence += static_cast<double>(l.weight.x) * -dot(l.direction, n) / n_samples;
            }
            flux.add(4 * pi * r * r * fluence);
        }
        const double power = set.lights()[0]->power();
        EXPECT_NEAR(flux.mean, power, 4.1 * flux.standard_error() + 2e-3 * power)
            << surface.index();
    }
}

TEST(SurfaceLight, LampsOfTheSceneAreSurfaces) {
    RectLightParams rect;
    rect.name = "panel";
    rect.position = Keyed<Vec3d>(Vec3d{0, 0, 4});
    rect.size = {2, 3};
    rect.power = Keyed<double>(12);
    rect.camera_visible = false;
    SphereLightParams bulb;
    bulb.radiance = Keyed<double>({0, 1}, {0, 5});
    PointParams point;
    Job job;
    SurfaceRig rig({}, {point, rect, bulb}, up, {}, {}, job);
    const SurfaceSet set = rig.at(0, 0, {});
    ASSERT_EQ(set.size(), 1);
    EXPECT_EQ(rig.at(1, 0, {}).size(), 2);
    EXPECT_TRUE(set.info(0).is_lamp);
    EXPECT_EQ(set.light_of(0), 0);
    EXPECT_EQ(set.info(0).name, "panel");
    EXPECT_NEAR(set.lights()[0]->power(), 12, 1e-4);
    const Ray ray{{0.5, 0.5, 0}, up};
    EXPECT_TRUE(set.intersect(ray));
    EXPECT_GT(set.intersect(ray)->emission.x, 0);
    EXPECT_FALSE(set.intersect(ray, 0.5f, RayKind::Camera));
    EXPECT_EQ(set.intersect({{0.5, 0.5, 8}, -up})->emission, Vec3f(0));
}

// A light that moves while the film is exposed is not drawn, but hit where it is.
TEST(SurfaceLight, MovingLightsAreOnlyFound) {
    SphereSurface s;
    s.center = Keyed<Vec3d>({0, 1}, {Vec3d{0, 0, 5}, Vec3d{4, 0, 5}});
    s.material.emission = Keyed<Vec3d>(Vec3d(1));
    const SurfaceSet set({s}, 0.5, up, 1);
    EXPECT_TRUE(set.lights().empty());
    EXPECT_EQ(set.light_of(0), -1);
    EXPECT_TRUE(set.intersect({{0, 0, 0}, up}, 0));
    EXPECT_FALSE(set.intersect({{0, 0, 0}, up}, 1));
    EXPECT_TRUE(set.intersect({{4, 0, 0}, up}, 1));
    EXPECT_TRUE(SurfaceSet({s}, 0.5, up, 0).lights().size() == 1);
}

}  // namespace
}  // namespace gischt
