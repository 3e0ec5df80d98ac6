// SPDX-License-Identifier: Apache-2.0
// The weights of the strategies of one path sum to 1: each is p_s^2 over the sum of the squares of
// densities that are multiplied out here vertex by vertex.
#include "render/bdpt/strategy_weights.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "render/bdpt/test_bdpt.h"

namespace gischt {
namespace {

using namespace bdpt_test;

// A whole path from the camera to a light.
struct WholePath {
    PathVertex eye;                           // where the camera sees it from
    std::vector<const PathVertex*> vertices;  // camera to the last one before the light
    std::vector<Vec3d> towards_light;         // of each, to the next
    std::vector<double> through;              // of the edge after each
    std::vector<double> to_light, to_camera;  // direction densities of each, 1/sr
    std::vector<bool> is_delta;
    LightEnd end;
};

void complete(const BdptTracer& tracer, const BdptScene& scene, const BdptTracer::Weighed& w,
              WholePath& p) {
    const SurfaceSet& surfaces = scene.view.surfaces;
    const auto& eye = tracer.camera().vertices;
    const auto& light = tracer.light().vertices;
    const std::size_t from_eye = w.s == 0 ? w.t - 1 : w.t;
    p.eye = eye[0];
    // Parallel rays of the film have origins of their own.
    if (w.t == 1) p.eye.point = scene.view.camera.see(light[w.s - 1].point)->origin;
    for (std::size_t i = 0; i < from_eye; ++i) p.vertices.push_back(i == 0 ? &p.eye : &eye[i]);
    for (std::size_t i = w.s; i-- > 1;) p.vertices.push_back(&light[i]);
    const std::size_t n = p.vertices.size();
    p.end = w.end ? *w.end : light_end_of(scene, light[0], light[1].point);
    for (std::size_t i = 0; i < n; ++i) {
        const bool is_last = i + 1 == n;
        p.towards_light.push_back(
            is_last ? p.end.direction : normalize(p.vertices[i + 1]->point - p.vertices[i]->point));
        // The edge is stored with the vertex that it leads to.
        const bool is_connection = w.s == 0 ? is_last : i + 1 == from_eye;
        p.through.push_back(is_connection      ? w.through
                            : i + 1 < from_eye ? p.vertices[i + 1]->through
                                               : p.vertices[i]->through);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const PathVertex& v = *p.vertices[i];
        const bool is_end = (w.s > 0 && i + 1 == from_eye) || (w.s > 1 && i == from_eye);
        p.is_delta.push_back(v.is_delta && !is_end);
        if (i == 0) {
            // The density of the camera, for the ray to the next vertex.
            const auto sight = scene.view.camera.see(
                n > 1 ? p.vertices[1]->point : v.point + p.end.direction, Vec2f{0.5f, 0.5f});
            p.to_light.push_back(sight->density);
            p.to_camera.push_back(0);
        } else if (p.is_delta[i]) {
            p.to_light.push_back(i < from_eye ? v.onward : v.return_);
            p.to_camera.push_back(i < from_eye ? v.return_ : v.onward);
        } else {
            const Vec3d back =
                i < from_eye ? v.back : normalize(p.vertices[i - 1]->point - v.point);
            const Vec3d on = i < from_eye ? p.towards_light[i] : v.back;
            p.to_light.push_back(direction_density(surfaces, v, back, on));
            p.to_camera.push_back(direction_density(surfaces, v, on, back));
        }
    }
}

// Squares of the densities of all strategies, s = 0 first.
std::vector<double> squares(const WholePath& p, const BdptScene& scene) {
    using Kind = EmittedLight::Kind;
    const std::size_t n = p.vertices.size();  // without the light
    const bool is_parallel = scene.view.camera.projection() == Projection::Orthographic;
    std::vector<double> by_camera(n + 1, 1), by_light(n + 1, 1);
    const auto d2 = [&](std::size_t i) {
        const Vec3d way = p.vertices[i + 1]->point - p.vertices[i]->point;
        return dot(way, way);
    };
    const bool is_far = p.end.kind == Kind::Infinity;
    const double to_end =
        is_far || p.end.kind == Kind::Point ? 1 : p.end.facing / (p.end.distance * p.end.distance);
    for (std::size_t i = 1; i < n; ++i) {
        by_camera[i] = p.to_light[i - 1] * p.vertices[i]->facing(p.towards_light[i - 1]) /
                       (i == 1 && is_parallel ? 1 : d2(i - 1));
    }
    by_camera[n] = p.end.is_delta ? 0 : p.to_light[n - 1] * to_end;
    if (p.end.kind == Kind::Volume) by_camera[n] *= scene.glow_rate;
    const auto& e = p.end.emitted;
    const auto or_one = [](float x) { return x > 0 ? double(x) : 1.0; };
    by_light[n] = double(e.choice) * or_one(is_far ? e.direction : e.place);
    by_light[n - 1] = double(is_far ? e.place : e.direction) *
                      p.vertices[n - 1]->facing(p.end.direction) /
                      (is_far ? 1 : p.end.distance * p.end.distance);
    for (std::size_t i = n - 1; i-- > 1;) {
        by_light[i] = p.to_camera[i + 1] * p.vertices[i]->facing(p.towards_light[i]) / d2(i);
    }
    std::vector<double> all;
    for (std::size_t s = 0; s <= n; ++s) {
        const std::size_t t = n + 1 - s;  // vertices of the camera's
        double product = 1;
        for (std::size_t i = 1; i < t; ++i) product *= by_camera[i];
        if (s == 1) {
            product *= p.end.kind == Kind::Volume ? p.end.sampled : p.end.sampled * to_end;
        } else {
            for (std::size_t i = t; i <= n; ++i) product *= by_light[i];
        }
        const bool meets =
            s == 0 || (s == 1 ? !p.is_delta[n - 1] : !p.is_delta[t - 1] && !p.is_delta[t]);
        if (!meets || (t == 1 && s == 1)) product = 0;
        if (s > 0) product /= p.through[t - 1];
        all.push_back(product * product);
    }
    return all;
}

View crowd() {
    View view = glass_and_smoke();
    Material shiny;
    shiny.kind = MaterialKind::Plastic;
    shiny.albedo = Vec3d(0.6);
    SphereSurface rough = ball({0.9, -0.6, -0.4}, 0.3, MaterialKind::Dielectric, 0.6);
    SphereSurface glass = ball({-0.3, 0, 0.1}, 0.6, MaterialKind::Dielectric);
    glass.material.medium = coefficients({1, 2, 3}, {0.95, 0.9, 0.8}, 0.5);
    view.surfaces =
        SurfaceSet({glass, rough, table(-0.75, shiny), lamp({-2, -1, 3}, 1.5, {6, 5, 4})}, 0);
    view.media = {flame(), solid(Region::box({Vec3d(-3), Vec3d(3)}),
                                 coefficients(Vec3d(0.1), Vec3d(0.9), 0.3))};
    view.lights = {uneven_sky(), sky(Vec3f(0.3f)), delta_sun({1, -1, 2}, Vec3f(2)),
                   std::make_shared<SunLight>(normalize(Vec3d(-1, -1, 2)), Vec3f(3, 2, 1), 0.3),
                   point({1, -2, 1}, Vec3f(3))};
    return view;
}

TEST(StrategyWeights, OfAPathSumToOne) {
    for (const bool is_ortho : {false, true}) {
        for (const auto weights : {StrategyWeights::Directions, StrategyWeights::Distances}) {
            View view = crowd();
            if (is_ortho) view.camera = ortho({1, -4, 2}, 3);
            BdptParams params;
            params.weights = weights;
            params.roulette = 0;
            Job job;
            const BdptScene scene(view, params, "bdpt", job);
            BdptTracer tracer(scene, 6, 0);
            int seen = 0;
            std::vector<int> of_kind(5, 0), of_s(4, 0);
            tracer.watch = [&](const BdptTracer::Weighed& w) {
                WholePath p;
                complete(tracer, scene, w, p);
                const std::vector<double> all = squares(p, scene);
                double sum = 0;
                for (const double x : all) sum += x;
                ASSERT_GT(all[w.s], 0) << w.s << " " << w.t;
                const double expected = all[w.s] / sum;
                EXPECT_NEAR(w.weight, expected, 1e-5)
                    << fmt::format("s {} t {} light {}", w.s, w.t, static_cast<int>(p.end.kind));
                ++seen;
                ++of_kind[static_cast<std::size_t>(p.end.kind)];
                ++of_s[std::min<std::size_t>(w.s, 3)];
            };
            for (std::uint32_t i = 0; i < 400; ++i) {
                const PixelSampler numbers(3, 1, 0, 0, i);
                const Vec2f place = numbers.two(0);
                tracer(view.camera.ray(double(place.x), double(place.y)), {0.5f, 0.5f}, numbers);
                if (HasFailure()) return;
            }
            EXPECT_GT(seen, 1000);
            for (std::size_t k = 1; k < 5; ++k) EXPECT_GT(of_kind[k], 10) << k;
            for (const int count : of_s) EXPECT_GT(count, 20);
        }
    }
}

}  // namespace
}  // namespace gischt
