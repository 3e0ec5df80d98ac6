// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/material.h"
#include "render/bdpt/bdpt_tracer.h"
#include "render/path/test_views.h"

// Views that bidirectional methods are compared with the path tracer on.
namespace gischt::bdpt_test {

using namespace path_test;

using Strategy = std::pair<std::size_t, std::size_t>;

// The mean radiance of a picture of one pixel, by a box filter.
inline Estimate mean_by_bdpt(const View& view, const BdptParams& params, const Effort& effort,
                             std::optional<Strategy> only = {}) {
    Job job;
    const BdptScene scene(view, params, "bdpt", job);
    BdptTracer tracer(scene, effort.depth, 0);
    tracer.only = only;
    return estimate(effort.batches, [&](int batch) {
        const std::uint64_t key = random_key(effort.seed, static_cast<std::uint64_t>(batch));
        Vec3d sum;
        for (int i = 0; i < effort.samples; ++i) {
            const PixelSampler numbers(key, 1, 0, 0, static_cast<std::uint32_t>(i));
            const Vec2f place = numbers.two(0), lens = numbers.two(1);
            const Ray ray = view.camera.ray(double(place.x), double(place.y), lens);
            sum += Vec3d(tracer(ray, lens, numbers).radiance);
            for (const FilmSplat& s : tracer.splats()) sum += Vec3d(s.value);
        }
        return sum / Vec3d(effort.samples);
    });
}

// The same by the path tracer, through the lens.
inline Estimate mean_by_path(const View& view, const Effort& effort) {
    PathParams params;
    Traced traced(view, params, effort.depth);
    return estimate(effort.batches, [&](int batch) {
        const std::uint64_t key = random_key(effort.seed, static_cast<std::uint64_t>(batch), 77ULL);
        Vec3d sum;
        for (int i = 0; i < effort.samples; ++i) {
            const PixelSampler numbers(key, 1, 0, 0, static_cast<std::uint32_t>(i));
            const Vec2f place = numbers.two(0), lens = numbers.two(1);
            const Ray ray = view.camera.ray(double(place.x), double(place.y), lens);
            sum += Vec3d(traced.tracer(ray, 0.5f, numbers).radiance);
        }
        return sum / Vec3d(effort.samples);
    });
}

struct NamedView {
    std::string name;
    View view;
    int depth = 8;
};

inline Camera perspective(const Vec3d& from, const Vec3d& to, double fov, double lens = 0) {
    CameraParams p;
    p.position = Keyed<Vec3d>(from);
    p.target = Keyed<Vec3d>(to);
    p.fov_degrees = Keyed<double>(fov);
    p.lens_radius = Keyed<double>(lens);
    return Camera(p, 0, 1, 1);
}

inline RectSurface lamp(const Vec3d& center, double edge, const Vec3d& radiance) {
    RectSurface rect;
    rect.name = "lamp";
    rect.center = Keyed<Vec3d>(center);
    rect.target = Keyed<Vec3d>(Vec3d{});
    rect.size = {edge, edge};
    rect.material.albedo = Vec3d(0);
    rect.material.emission = Keyed<Vec3d>(radiance);
    return rect;
}

inline BoxSurface table(double top, const Material& material = {}) {
    BoxSurface box;
    box.name = "table";
    box.center = Keyed<Vec3d>(Vec3d(0, 0, top - 0.1));
    box.size = {4, 4, 0.2};
    box.material = material;
    return box;
}

inline SphereSurface ball(const Vec3d& center, double radius, MaterialKind kind,
                          double roughness = 0) {
    SphereSurface sphere;
    sphere.name = "ball";
    sphere.center = Keyed<Vec3d>(center);
    sphere.radius = Keyed<double>(radius);
    sphere.material.kind = kind;
    sphere.material.roughness = roughness;
    if (kind == MaterialKind::Plastic) sphere.material.albedo = Vec3d(0.7, 0.5, 0.3);
    return sphere;
}

inline MediumPtr cloud_of(const Vec3d& extinction, double g, const Vec3d& shift,
                          std::uint64_t seed) {
    return voxels(
        16, [=](const Vec3d& p) { return lumps(p + shift, seed); },
        coefficients(extinction, {0.95, 0.9, 0.8}, g));
}

inline MediumPtr flame() {
    Frame frame;
    add_field(frame, "density", 16, [](const Vec3d& p) { return lumps(p); });
    // It burns next to the smoke too.
    add_field(frame, "flame", 16,
              [](const Vec3d& p) { return std::max(0.0, 1 - 2 * length(p - Vec3d(0.4, 0, 0.4))); });
    MediumParams p = coefficients({2, 4, 8}, {0.7, 0.6, 0.5}, 0.5);
    p.emission = EmissionKind::Flame;
    Job job;
    return std::make_shared<const Medium>(frame, p, 0, job);
}

inline LightPtr uneven_sky() {
    return std::make_shared<EnvironmentLight>(
        std::make_shared<EnvironmentMap>(
            32, 16,
            [](const Vec3d& d) { return Vec3f(static_cast<float>(std::exp(2 * d.x + d.z))); }),
        Transform{}, Vec3f(1));
}

inline LightPtr point(const Vec3d& place, const Vec3f& intensity) {
    return std::make_shared<PointLight>(place, intensity);
}

// Glass over a table, filled with coloured smoke.
inline View glass_and_smoke() {
    View view;
    view.camera = perspective({0, -5, 1.2}, {0, 0, 0}, 30);
    SphereSurface glass = ball({0, 0, 0.1}, 0.8, MaterialKind::Dielectric);
    glass.material.medium = coefficients({1, 2, 3}, {0.95, 0.9, 0.8}, 0.5);
    view.surfaces = SurfaceSet({glass, table(-0.75), lamp({-2, -1, 3}, 1.5, {6, 5, 4})}, 0);
    view.background = Vec3f{};
    return view;
}

// Everything that scatters without a medium.
inline View materials() {
    View view;
    view.camera = perspective({0, -6, 2}, {0, 0, 0}, 30);
    Material floor;
    floor.albedo = Vec3d(0.7, 0.6, 0.5);
    std::vector<SurfaceParams> all{table(-0.5, floor), lamp({-2, -2, 3}, 1, {8, 8, 8})};
    const auto add = [&](double x, double y, MaterialKind kind, double roughness) {
        all.push_back(ball({x, y, -0.1}, 0.35, kind, roughness));
    };
    add(-1.2, -0.4, MaterialKind::Lambert, 0);
    add(-0.4, -0.4, MaterialKind::Conductor, 0);
    add(0.4, -0.4, MaterialKind::Conductor, 0.5);
    add(1.2, -0.4, MaterialKind::Dielectric, 0);
    add(-1.2, 0.6, MaterialKind::Dielectric, 0.5);
    add(-0.4, 0.6, MaterialKind::Plastic, 0);
    add(0.4, 0.6, MaterialKind::Plastic, 0.4);
    view.surfaces = SurfaceSet(all, 0);
    view.background = Vec3f{};
    return view;
}

inline std::vector<NamedView> agreement_views() {
    std::vector<NamedView> all;
    const auto add = [&](const std::string& name, int depth) -> View& {
        all.push_back({name, {}, depth});
        all.back().view.camera = ortho({2, -3, 1}, 2);
        all.back().view.background = Vec3f{};
        return all.back().view;
    };
    View& fog = add("homogeneous ball", 12);
    fog.media = {solid(Region::sphere({}, 1), coefficients(Vec3d(3), Vec3d(0.9), 0.5))};
    fog.lights = {delta_sun({-1, 1, 1}, {3, 2, 1}), point({1.3, 0.2, 0.9}, Vec3f(1, 2, 3))};

    View& clouds = add("coloured clouds that overlap, sun and lamp", 6);
    clouds.media = {cloud_of({1, 4, 15}, 0.7, {}, 7), cloud_of({5, 2, 0}, -0.4, {0.6, 0, 0.4}, 5)};
    clouds.lights = {std::make_shared<SunLight>(normalize(Vec3d(-1, 1, 1)), Vec3f(3, 2, 1), 0.3)};
    clouds.surfaces = SurfaceSet({lamp({1.2, -0.5, 0.8}, 0.6, {6, 5, 4})}, 0);

    View& sky = add("cloud under an uneven and an even sky", 5);
    sky.media = {cloud_of({3, 4, 5}, 0.3, {}, 7)};
    sky.lights = {uneven_sky(), path_test::sky({0.1f, 0.2f, 0.3f})};
    sky.background.reset();

    View& fire = add("flame and wall", 4);
    fire.media = {flame()};
    BoxSurface wall;
    wall.center = Keyed<Vec3d>(Vec3d(0.4, 0.1, 0.2));
    wall.size = {0.05, 1.5, 1};
    fire.surfaces = SurfaceSet({wall}, 0);

    all.push_back({"glass ball with smoke under a lamp", glass_and_smoke(), 8});
    all.push_back({"every material", materials(), 40});

    View& lens = add("through a lens", 5);
    lens.camera = perspective({0, -4, 1}, {0, 0, 0}, 35, 0.25);
    lens.media = {cloud_of({2, 3, 4}, 0.3, {}, 7)};
    lens.lights = {delta_sun({-1, -1, 1}, {3, 2, 1})};
    lens.surfaces = SurfaceSet({table(-0.7)}, 0);

    View& hidden = add("boundaries without a surface, a hidden lamp", 6);
    SphereSurface bag = ball({}, 0.7, MaterialKind::None);
    bag.material.medium = coefficients({2, 3, 4}, Vec3d(0.9), 0.2);
    RectSurface unseen = lamp({0.8, -1.2, 0.4}, 0.6, {6, 5, 4});
    unseen.material.camera_visible = false;
    hidden.media = {
        solid(Region::box({Vec3d(-2), Vec3d(2)}), coefficients(Vec3d(0.3), Vec3d(0.9)))};
    hidden.surfaces = SurfaceSet({bag, unseen}, 0);
    return all;
}

}  // namespace gischt::bdpt_test
