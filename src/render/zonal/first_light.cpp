// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/first_light.h"

#include <cmath>

#include "base/parallel.h"
#include "base/units.h"

namespace gischt {

FirstLight::FirstLight(const View& view, const ZoneGrid& grid, int samples)
    : view_(view), grid_(grid), samples_(samples) {
    for (const LightPtr& light : view.lights) lights_.push_back(light.get());
    for (const auto& light : view.surfaces.lights()) lights_.push_back(light.get());
}

// Even in three dimensions for any number of points (Roberts 2018, R3).
Vec3d FirstLight::place(int i) {
    const double g = 1.22074408460575947536;  // the root of x^4 = x + 1
    const double n = i + 0.5;
    const auto part = [](double x) { return x - std::floor(x); };
    return {part(0.5 + n / g), part(0.5 + n / (g * g)), part(0.5 + n / (g * g * g))};
}

// The first surface that a ray meets shows its inside there.
bool FirstLight::is_inside_solid(const Vec3d& point) const {
    if (view_.surfaces.is_empty()) return false;
    // No axis of the scene, so that edges of boxes are not met.
    const auto hit = view_.surfaces.intersect({point, normalize(Vec3d{0.3190, 0.5241, 0.7897})});
    return hit && !hit->front && !view_.surfaces.info(hit->surface).is_sheet;
}

Vec3f FirstLight::sample(std::size_t light, Ray ray, int i, Vec3d& direction) const {
    const Vec2f u = sobol_2d(static_cast<std::uint32_t>(i), 77 + static_cast<std::uint32_t>(light));
    const LightSample s = lights_[light]->sample(ray.origin, u);
    if (!(max_component(s.weight) > 0)) return {};
    direction = s.direction;
    ray.direction = s.direction;
    ray.t_max = s.distance;
    if (view_.surfaces.is_blocked(ray)) return {};
    const Interval inside = clip(ray, grid_.box);
    if (inside.is_empty()) return s.weight;
    Ray through = ray;
    through.origin = ray.at(inside.t0);
    through.t_max = inside.t1 - inside.t0;
    return s.weight * exp(-grid_.depth(through));
}

Vec3f FirstLight::at_surface(const SurfaceHit& hit, int i) const {
    Vec3f sum;
    for (std::size_t l = 0; l < lights_.size(); ++l) {
        const Ray ray{hit.point + hit.offset * hit.normal, {}};
        Vec3d direction;
        const Vec3f weight = sample(l, ray, i, direction);
        const double cosine = dot(direction, hit.normal);
        if (cosine > 0) sum += static_cast<float>(cosine / pi) * weight;
    }
    return sum;
}

std::vector<Vec3f> FirstLight::mean_radiance(Job& job) const {
    std::vector<Vec3f> mean(grid_.size());
    parallel_for(static_cast<int>(mean.size()), 64, [&](int i) {
        const auto zone = static_cast<std::size_t>(i);
        if (i % 64 == 0) job.check();
        for_zone(zone, [&](const Vec3d&, const Vec3f& weight) {
            mean[zone] += static_cast<float>(0.25 / pi) * weight;
        });
    });
    return mean;
}

}  // namespace gischt
