// SPDX-License-Identifier: Apache-2.0
// What photons carry, against closed forms.
#include <gtest/gtest.h>

#include "base/units.h"
#include "render/photon/photon_views.h"

namespace gischt {
namespace {

using namespace photon_test;

LightPtr point_light(const Vec3d& at, const Vec3f& intensity) {
    return std::make_shared<PointLight>(at, intensity);
}

PhotonParams kept(std::int64_t photons) {
    PhotonParams params;
    params.photons = photons;
    return params;
}

Vec3d power_of(const std::vector<Photon>& photons) {
    Vec3d sum;
    for (const Photon& p : photons) sum += Vec3d(p.power);
    return sum;
}

// In a medium from which next to nothing escapes the k-th scattering carries albedo^k of the power,
// per channel. The first is left to direct light.
TEST(PhotonTracer, CarriesThePowerOfItsSource) {
    View view;
    const Vec3d albedo{0.5, 0.9, 0.98};
    view.media = {solid(Region::sphere({1, 2, 3}, 60), coefficients({0.5, 1, 2}, albedo, 0.3))};
    view.lights = {point_light({1, 2, 3}, {1, 2, 3})};
    Mapped mapped(view, kept(20'000), 10'000);
    EXPECT_LT(mapped.count.kept_share, 1);  // so often are these scattered
    const Estimate got = estimate(32, [&](int batch) {
        return power_of(trace_photons(mapped.scene, mapped.count, 5, batch, mapped.job).in_media);
    });
    for (int c = 0; c < 3; ++c) {
        const double truth = 4 * pi * (c + 1) * albedo[c] * albedo[c] / (1 - albedo[c]);
        expect_mean(got, c, truth, 6, "volume");
        EXPECT_LT(got.error[c], 0.03 * truth);
    }
    // And none after the last one.
    Mapped shallow(view, kept(20'000), 3);
    const Estimate three = estimate(32, [&](int batch) {
        return power_of(
            trace_photons(shallow.scene, shallow.count, 6, batch, shallow.job).in_media);
    });
    for (int c = 0; c < 3; ++c) {
        const double a = albedo[c];
        expect_mean(three, c, 4 * pi * (c + 1) * (a * a + a * a * a), 6, "depth 3");
    }
}

// Between walls of albedo a the k-th arrival carries a^(k - 1).
TEST(PhotonTracer, CarriesThePowerOfItsSourceBetweenWalls) {
    BoxSurface room;
    room.center = Keyed<Vec3d>(Vec3d(1, 2, 3));
    room.material.albedo = Vec3d(0.5, 0.7, 0.3);
    View view;
    view.surfaces = SurfaceSet({room}, 0);
    view.lights = {point_light({1.1, 1.8, 3.2}, {1, 1, 1})};
    Mapped mapped(view, kept(20'000), 10'000);
    const Estimate got = estimate(32, [&](int batch) {
        return power_of(
            trace_photons(mapped.scene, mapped.count, 7, batch, mapped.job).on_surfaces);
    });
    for (int c = 0; c < 3; ++c) {
        const double a = (*room.material.albedo)[c];
        expect_mean(got, c, 4 * pi * a / (1 - a), 3, "walls");
    }
}

// Where each order of a ray that meets a glass ball at a distance of b radii from its axis crosses
// the plane behind the ball, and with which share of its light: reflected outside (0), refracted
// through (1), and after further reflections inside.
struct BallRay {
    double place = 0, share = 0;  // m from the axis; negative where it does not come there
};
BallRay through_ball(double b, double n, int order, double radius, double plane) {
    const double i = std::asin(b), r = std::asin(b / n);
    const double c1 = std::cos(i), c2 = std::cos(r);
    const double s = (c1 - n * c2) / (c1 + n * c2), p = (n * c1 - c2) / (n * c1 + c2);
    const double f = 0.5 * (s * s + p * p);
    // The place of entry is at the angle pi - i from the direction of travel; each way inside turns
    // it by pi - 2r, and the last refraction bends by i - r.
    double at = pi - i, heading = 0, share = f;
    if (order == 0) {
        heading = pi - 2 * i;
    } else {
        at -= order * (pi - 2 * r);
        heading = -(2 * (i - r) + (order - 1) * (pi - 2 * r));
        share = (1 - f) * (1 - f) * std::pow(f, order - 1);
    }
    const double x = radius * std::cos(at), y = radius * std::sin(at);
    const double dx = std::cos(heading), dy = std::sin(heading);
    if (dx <= 0) return {0, 0};
    return {std::abs(y + (plane - x) * dy / dx), share};
}

// A sun through a glass ball on a screen behind it: the power in discs around the axis is the
// integral of what Fresnel lets through, ring by ring.
TEST(PhotonTracer, GlassBallMakesTheCausticOfFresnelAndSnell) {
    constexpr double radius = 1, n = 1.5, plane = 2.2;
    SphereSurface ball;
    ball.radius = Keyed<double>(radius);
    ball.material.kind = MaterialKind::Dielectric;
    ball.material.ior = n;
    RectSurface screen;
    screen.center = Keyed<Vec3d>(Vec3d(0, 0, -plane));
    screen.size = {20, 20};
    screen.material.albedo = Vec3d(0.5);
    View view;
    view.surfaces = SurfaceSet({ball, screen}, 0);
    view.lights = {delta_sun({0, 0, 1}, Vec3f(2))};
    Mapped mapped(view, kept(10'000), 1);
    const Vec3d discs{0.1, 0.4, 1.5};
    Vec3d truth;
    constexpr int rings = 20'000;
    for (int k = 0; k < rings; ++k) {
        const double b = (k + 0.5) / rings;
        for (int order = 0; order < 8; ++order) {
            const BallRay ray = through_ball(b, n, order, radius, plane);
            for (int d = 0; d < 3; ++d) {
                if (ray.share > 0 && ray.place < discs[d]) {
                    truth[d] += 2 * 2 * pi * b / rings * ray.share;
                }
            }
        }
    }
    const Estimate got = estimate(32, [&](int batch) {
        Vec3d sum;
        for (const Photon& p :
             trace_photons(mapped.scene, mapped.count, 8, batch, mapped.job).on_surfaces) {
            EXPECT_EQ(p.events, 1);
            const Vec3d at = Vec3d(p.position) + mapped.scene.origin;
            for (int d = 0; d < 3; ++d) {
                if (std::hypot(at.x, at.y) < discs[d] && at.z < -2) sum[d] += double(p.power.x);
            }
        }
        return sum;
    });
    for (int d = 0; d < 3; ++d) {
        expect_mean(got, d, truth[d], 3, "disc", 1e-3);
        EXPECT_LT(got.error[d], 0.01 * truth[d]);
    }
}

// All that the ball takes from the light of a point it gives back.
TEST(PhotonTracer, GlassLosesNothing) {
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(0, 0, 2.5));
    ball.material.kind = MaterialKind::Dielectric;
    SphereSurface room;
    room.radius = Keyed<double>(10);
    room.material.albedo = Vec3d(0.5);
    View view;
    view.surfaces = SurfaceSet({ball, room}, 0);
    view.lights = {point_light({0, 0, 0}, Vec3f(1))};
    Mapped mapped(view, kept(4000), 1);
    const double cosine = std::sqrt(1 - 1 / 6.25);
    const Estimate got = estimate(32, [&](int batch) {
        return power_of(
            trace_photons(mapped.scene, mapped.count, 9, batch, mapped.job).on_surfaces);
    });
    expect_mean(got, 0, 2 * pi * (1 - cosine), 1, "ball", 1e-4);
}

// The photons that are aimed and the others together are those that are not aimed at all.
TEST(PhotonTracer, AimChangesNoMean) {
    View view;
    view.media = {solid(Region::sphere({0, 0, 1}, 0.4), coefficients(Vec3d(4), Vec3d(0.8)))};
    RectSurface floor;
    floor.size = {6, 6};
    floor.material.albedo = Vec3d(0.5);
    RectSurface lamp;
    lamp.center = Keyed<Vec3d>(Vec3d(1, 1, 3));
    lamp.normal = {0, 0, -1};
    lamp.material.emission = Keyed<Vec3d>(Vec3d(2));
    view.surfaces = SurfaceSet({floor, lamp}, 0);
    view.lights = {delta_sun({1, 0, 1}, {1, 0, 0}), sky({0, 1, 0}),
                   point_light({-1, 0, 3}, {1, 1, 1})};
    const auto powers = [&](double aim, bool in_media) {
        PhotonParams params = kept(4000);
        params.aim = aim;
        Mapped mapped(view, params, 4);
        EXPECT_EQ(mapped.scene.aimed.has_value(), aim > 0);
        return estimate(32, [&](int batch) {
            const PhotonSet set = trace_photons(mapped.scene, mapped.count, 10, batch, mapped.job);
            return power_of(in_media ? set.in_media : set.on_surfaces);
        });
    };
    expect_same_mean(powers(0.6, true), powers(0, true), 6, "media");
    expect_same_mean(powers(0.6, false), powers(0, false), 6, "surfaces");
}

}  // namespace
}  // namespace gischt
