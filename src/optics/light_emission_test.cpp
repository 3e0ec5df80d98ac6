// SPDX-License-Identifier: Apache-2.0
#include "optics/light_emission.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "math/quadrature.h"
#include "optics/environment.h"
#include "optics/local_lights.h"
#include "optics/surface_params.h"
#include "optics/surface_rig.h"
#include "optics/test_chi_squared.h"
#include "shape/mesh.h"
#include "shape/shape.h"
#include "shape/solid_angle.h"

namespace gischt {
namespace {

using Kind = EmittedLight::Kind;

const Box3d reach{{-1, -0.8, -0.6}, {1, 0.8, 0.6}};

EmittedLight draw(const LightEmission& emission, std::uint64_t key) {
    const auto u = [key](std::uint32_t d) { return random_uniform(key, d); };
    return emission.sample(u(0), {u(1), u(2)}, {u(3), u(4)}, u(5));
}

View lit_by(LightPtr light) {
    View view;
    view.lights = {std::move(light)};
    return view;
}

SurfaceSet glowing(SurfaceParams surface, double radiance) {
    std::visit([&](auto& s) { s.material.emission = Keyed<Vec3d>(Vec3d(radiance)); }, surface);
    Job job;
    SurfaceRig rig(
        {surface}, {}, {0, 0, 1}, [](const std::string&, Job&) { return ball_mesh(0.5, 1); }, {},
        job);
    return rig.at(0, 0, {});
}

View lamp(const SurfaceParams& surface, double radiance = 1) {
    View view;
    view.surfaces = glowing(surface, radiance);
    return view;
}

std::vector<SurfaceParams> lamps() {
    SphereSurface sphere;
    sphere.radius = Keyed<double>(0.3);
    BoxSurface box;
    box.size = {0.4, 0.6, 0.2};
    box.rotation_degrees = Keyed<Vec3d>(Vec3d(10, 20, 30));
    RectSurface sheet;
    sheet.size = {0.5, 0.3};
    sheet.normal = {0.3, 0.1, 1};
    RectSurface both = sheet;
    both.two_sided = true;
    DiscSurface disc;
    disc.radius = 0.4;
    disc.normal = {0, 1, 0.2};
    MeshSurface mesh;
    mesh.file = "ball";
    return {sphere, box, sheet, both, disc, mesh};
}

// Mean and standard error.
struct Mean {
    double value = 0, error = 0;
};
template <class F>
Mean mean_of(int n, std::uint64_t seed, F&& f) {
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        const double v = f(random_key(seed, static_cast<std::uint64_t>(i)));
        sum += v;
        squares += v * v;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

// At 4.3 standard errors two dozen comparisons have a family-wise significance of 5e-4.
void expect_mean(const Mean& got, double truth, const char* name, double rounding = 1e-5) {
    EXPECT_NEAR(got.value, truth, 4.3 * got.error + rounding * truth) << name;
}

Mean flux(const LightEmission& emission, std::uint64_t seed, int n = 100'000) {
    return mean_of(n, seed, [&](std::uint64_t key) {
        return static_cast<double>(draw(emission, key).power.x);
    });
}

double solid_angle_of_side(const Vec3d& from) {
    // Of the reach, seen from above its middle: its upper side.
    return SphericalRectangle(from, {-1, -0.8, 0.6}, {2, 0, 0}, {0, 1.6, 0}).solid_angle();
}

TEST(LightEmission, PowerOfPointsIsIntensityTimesTheSolidAngleOfTheTarget) {
    Job job;
    const Vec3f intensity(3);
    for (const auto& [at, angle] : {std::pair{Vec3d(0.2, 0.1, 0.3), 4 * pi},
                                    std::pair{Vec3d(0, 0, 3), solid_angle_of_side({0, 0, 3})},
                                    std::pair{Vec3d(0, 0, 5000), 3.2 / (4999.4 * 4999.4)}}) {
        const View view = lit_by(std::make_shared<PointLight>(at, intensity));
        const LightEmission emission(view, reach, {}, job);
        expect_mean(flux(emission, 1), 3 * angle, "point", 1e-4);
        EXPECT_NEAR(emission.power(), 3 * angle, 0.2 * angle);
    }
}

TEST(LightEmission, PowerOfSpotsIsThatOfTheirConeInTheTarget) {
    Job job;
    const double inner = 0.2, outer = 0.35;
    const double whole = 2 * pi * (1 - 0.5 * (std::cos(inner) + std::cos(outer)));
    // The whole cone meets a far side; a small aim within the inner cone has full intensity.
    const View view = lit_by(
        std::make_shared<SpotLight>(Vec3d(0, 0, 1.6), Vec3d(0, 0, -1), Vec3f(2), inner, outer));
    expect_mean(flux(LightEmission(view, reach, {}, job), 2), 2 * whole, "cone");
    const Box3d aim{{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};
    const double angle =
        SphericalRectangle({0, 0, 1.6}, {-0.1, -0.1, 0.1}, {0.2, 0, 0}, {0, 0.2, 0}).solid_angle();
    expect_mean(flux(LightEmission(view, reach, aim, job), 3), 2 * angle, "aim");
}

TEST(LightEmission, PowerFromInfinityIsThatThroughTheBox) {
    Job job;
    const Vec3d towards = normalize(Vec3d(1, 2, 3));
    const double across = 1.6 * 1.2 * towards.x + 2 * 1.2 * towards.y + 2 * 1.6 * towards.z;
    for (const double size : {0.0, 0.01}) {
        const View view = lit_by(std::make_shared<SunLight>(towards, Vec3f(5), size));
        expect_mean(flux(LightEmission(view, reach, {}, job), 4), 5 * across, "sun", 1e-4);
    }
    const double area = 2 * (2 * 1.6 + 2 * 1.2 + 1.6 * 1.2);
    const View even = lit_by(std::make_shared<ConstantLight>(Vec3f(0.7f)));
    expect_mean(flux(LightEmission(even, reach, {}, job), 5), 0.7 * pi * area, "constant");

    // A sky of 1 + z: by a rule over the sphere.
    const auto map = std::make_shared<const EnvironmentMap>(
        256, 128, [](const Vec3d& d) { return Vec3f(static_cast<float>(1 + d.z)); });
    const View sky = lit_by(
        std::make_shared<EnvironmentLight>(map, Transform::rotation({1, 0, 0}, 0.5), Vec3f(2)));
    const GaussLegendre rule(32);
    const double truth = rule.integrate(-1, 1, [&](double z) {
        return rule.integrate(0, 2 * pi, [&](double turn) {
            const double r = std::sqrt(1 - z * z);
            const Vec3d d(r * std::cos(turn), r * std::sin(turn), z);
            return static_cast<double>(sky.lights[0]->radiance(d).x) *
                   (1.6 * 1.2 * std::abs(d.x) + 2 * 1.2 * std::abs(d.y) + 2 * 1.6 * std::abs(d.z));
        });
    });
    expect_mean(flux(LightEmission(sky, reach, {}, job), 6), truth, "sky", 1e-3);
}

TEST(LightEmission, PowerOfSurfacesIsPiTimesAreaTimesRadiance) {
    Job job;
    for (const SurfaceParams& surface : lamps()) {
        View view = lamp(surface, 1.5);
        const SurfaceLight& light = *view.surfaces.lights()[0];
        CameraParams eye;
        view.camera = Camera(eye, 0, 16, 16);
        expect_mean(flux(LightEmission(view, reach, {}, job), 7), light.power(), "outside");
        // A closed shape around the camera shines inwards as well.
        eye.position = Keyed<Vec3d>(Vec3d(0, 0, 0.01));
        eye.target = Keyed<Vec3d>(Vec3d(1, 0, 0));
        view.camera = Camera(eye, 0, 16, 16);
        const double sides = light.is_closed() ? 2 : 1;
        expect_mean(flux(LightEmission(view, reach, {}, job), 7), sides * light.power(), "inside");
    }
}

MediumParams coal() {
    MediumParams params;
    params.absorption = Keyed<Vec3d>(Vec3d(0.7));
    params.scattering = Keyed<Vec3d>(Vec3d(0));
    params.emission = EmissionKind::Blackbody;
    params.emission_scale = Keyed<double>(1e-3);
    return params;
}

TEST(LightEmission, PowerOfMediaIsFourPiTimesTheirEmission) {
    Job job;
    View view;
    view.media = {std::make_shared<const Medium>(Region::sphere({0, 0, 0}, 0.5), coal(), 0, 1500),
                  std::make_shared<const Medium>(Region::box({{0.6, 0, 0}, {0.9, 0.3, 0.5}}),
                                                 coal(), 0, 1700)};
    const double a = static_cast<double>(view.media[0]->at({0, 0, 0}).emission.x),
                 b = static_cast<double>(view.media[1]->at({0.7, 0.1, 0.1}).emission.x);
    const double truth = 4 * pi * (a * pi / 6 + b * 0.045);
    expect_mean(flux(LightEmission(view, reach, {}, job), 8), truth, "media");
}

// Densities, as those who meet a source by chance ask for them.
TEST(LightEmission, DensitiesAreThoseOfTheSamples) {
    Job job;
    View view;
    view.lights = {std::make_shared<PointLight>(Vec3d(0, 0, 2), Vec3f(1)),
                   std::make_shared<SpotLight>(Vec3d(2, 0, 0), Vec3d(-1, 0, 0), Vec3f(1), 0.1, 0.3),
                   std::make_shared<SunLight>(Vec3d(0, 0, 1), Vec3f(1), 0.02),
                   std::make_shared<ConstantLight>(Vec3f(0.3f))};
    RectSurface sheet;
    sheet.two_sided = true;
    view.surfaces = glowing(sheet, 1);
    view.media = {std::make_shared<const Medium>(Region::sphere({0, 0, 0}, 0.5), coal(), 0, 1500)};
    const LightEmission emission(view, reach, Box3d{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.4}}, job);
    std::vector<int> seen(emission.sources().size(), 0);
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        const EmittedLight e = draw(emission, random_key(9, i));
        if (e.kind == Kind::None) continue;
        ++seen[static_cast<std::size_t>(e.source)];
        const Vec3d& d = e.ray.direction;
        const auto got = e.kind == Kind::Point      ? emission.of_point(e.source, d)
                         : e.kind == Kind::Infinity ? emission.of_infinity(e.source, d)
                         : e.kind == Kind::Surface  ? emission.of_surface(*e.hit, d)
                                                    : emission.of_medium(e.source, e.ray.origin);
        ASSERT_NEAR(got.choice, e.choice, 1e-5 * e.choice);
        ASSERT_NEAR(got.place, e.pdf_place, 1e-5 * e.pdf_place) << e.source;
        ASSERT_NEAR(got.direction, e.pdf_direction, 1e-4 * e.pdf_direction) << e.source;
    }
    for (std::size_t s = 0; s < seen.size(); ++s) {
        const double expected = 20'000 * emission.sources()[s].power / emission.power();
        EXPECT_GT(seen[s], 0.5 * expected) << s;
        EXPECT_LT(seen[s], expected + 5 * std::sqrt(expected)) << s;
    }
}

// And they are densities of these samples.
TEST(LightEmission, DirectionsHaveTheirDensities) {
    Job job;
    const LightPtr lights[] = {
        std::make_shared<PointLight>(Vec3d(1.4, 0.9, -1.2), Vec3f(1)),
        std::make_shared<PointLight>(Vec3d(0, 0, 0.2), Vec3f(1)),
        std::make_shared<SpotLight>(Vec3d(0, 0, 0), normalize(Vec3d(1, 1, 1)), Vec3f(1), 0.4, 1.2)};
    std::uint64_t seed = 20;
    for (const LightPtr& light : lights) {
        const View view = lit_by(light);
        const LightEmission emission(view, reach, {}, job);
        const ChiSquared test = chi_squared(
            [&](std::uint64_t key) -> std::optional<Vec3d> {
                const EmittedLight e = draw(emission, key);
                if (e.kind == Kind::None) return {};
                return e.ray.direction;
            },
            [&](const Vec3d& d) { return static_cast<double>(emission.of_point(0, d).direction); },
            ++seed, 6);
        EXPECT_GT(test.p_value, 1e-4) << test.statistic << " of " << test.freedom;
    }
}

// Where rays of parallel light enter a box, seen along them.
TEST(LightEmission, PlacesAcrossAreEven) {
    const BoxTarget target(reach);
    const Vec3d along = normalize(Vec3d(-1, 2, -1.5));
    // The moments of the silhouette, by the rays of a fine grid that meet the box.
    Vec3d s, t;
    orthonormal_frame(along, s, t);
    double area = 0, ss = 0, tt = 0;
    constexpr int n = 600;
    for (int i = 0; i < n * n; ++i) {
        const double x = 4 * ((i % n + 0.5) / n - 0.5), y = 4 * ((i / n + 0.5) / n - 0.5);
        if (!target.is_met_by({x * s + y * t - 9.0 * along, along})) continue;
        const double cell = 16.0 / n / n;
        area += cell;
        ss += cell * x * x;
        tt += cell * y * y;
    }
    EXPECT_NEAR(target.area_across(along), area, 2e-3 * area);
    const auto moment = [&](const Vec3d& axis, std::uint64_t seed) {
        return mean_of(100'000, seed, [&](std::uint64_t key) {
            const Vec3d p = target.entry(along, {random_uniform(key, 0), random_uniform(key, 1)},
                                         random_uniform(key, 2));
            return dot(p, axis) * dot(p, axis);
        });
    };
    expect_mean(moment(s, 30), ss / area, "s", 3e-3);
    expect_mean(moment(t, 31), tt / area, "t", 3e-3);
}

// The fluence in a small ball, from the lengths of rays in it, is that which the light tells for
// its middle.
Mean fluence(const LightEmission& emission, const Sphere& ball, std::uint64_t seed, int n) {
    const double volume = 4 * pi / 3 * std::pow(ball.radius, 3);
    return mean_of(n, seed, [&](std::uint64_t key) {
        const EmittedLight e = draw(emission, key);
        if (e.kind == Kind::None) return 0.0;
        const Vec3d to = ball.center - e.ray.origin;
        const double along = dot(to, e.ray.direction),
                     h2 = ball.radius * ball.radius - (dot(to, to) - along * along);
        if (h2 <= 0 || along <= 0) return 0.0;
        return static_cast<double>(e.power.x) * 2 * std::sqrt(h2) / volume;
    });
}

TEST(LightEmission, RaysGiveTheFluenceOfEachLight) {
    Job job;
    const Sphere ball{{0.1, 0.2, -0.1}, 0.05};
    const Box3d aim{ball.center - Vec3d(0.051), ball.center + Vec3d(0.051)};
    const auto map = std::make_shared<const EnvironmentMap>(
        64, 32, [](const Vec3d& d) { return Vec3f(static_cast<float>(1 + d.z + d.x * d.y)); });
    const LightPtr lights[] = {
        std::make_shared<PointLight>(Vec3d(0.3, -0.4, 1.4), Vec3f(2)),
        std::make_shared<SpotLight>(Vec3d(1.5, 0.2, -0.1), Vec3d(-1, 0, 0), Vec3f(2), 0.1, 0.2),
        std::make_shared<SunLight>(normalize(Vec3d(1, -1, 1)), Vec3f(4), 0),
        std::make_shared<SunLight>(normalize(Vec3d(1, -1, 1)), Vec3f(4), 0.3),
        std::make_shared<ConstantLight>(Vec3f(0.6f)),
        std::make_shared<EnvironmentLight>(map, Transform{}, Vec3f(2))};
    std::uint64_t seed = 40;
    for (const LightPtr& light : lights) {
        const View view = lit_by(light);
        const double truth = 4 * pi * static_cast<double>(light->mean_radiance(ball.center).x);
        const LightEmission whole(view, reach, {}, job), aimed(view, reach, aim, job);
        // That of 1/r^2 varies by r^2 / 5 d^2 over the ball.
        expect_mean(fluence(aimed, ball, ++seed, 60'000), truth, "aimed", 1e-3);
        expect_mean(fluence(whole, ball, ++seed, 60'000), truth, "whole", 1e-3);
    }
    for (const SurfaceParams& surface : lamps()) {
        if (std::holds_alternative<MeshSurface>(surface)) continue;  // whose mean is an estimate
        const View view = lamp(surface, 3);
        const Sphere far{{0.3, 0.5, 0.8}, 0.1};
        const double truth =
            4 * pi * static_cast<double>(view.surfaces.lights()[0]->mean_radiance(far.center).x);
        expect_mean(fluence(LightEmission(view, reach, {}, job), far, ++seed, 400'000), truth,
                    "lamp", 1e-2);
    }
}

}  // namespace
}  // namespace gischt
