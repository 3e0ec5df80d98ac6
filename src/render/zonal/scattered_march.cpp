// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/scattered_march.h"

#include <algorithm>
#include <cmath>

#include "math/fast_math.h"

namespace gischt {
namespace {

constexpr float cutoff = 1e-4f;  // transmittance at which a ray ends

Vec3f dimmed(const Vec3f& depth) {
    return {fast_exp(-depth.x), fast_exp(-depth.y), fast_exp(-depth.z)};
}

// (1 - exp(-e ds)) / e for the depth e ds.
Vec3f source_length(const Vec3f& depth, float ds) {
    Vec3f length;
    for (int c = 0; c < 3; ++c) {
        const float x = depth[c];
        length[c] = x < 1e-3f ? ds * (1 - 0.5f * x) : ds * (1 - fast_exp(-x)) / x;
    }
    return length;
}

// Metres in which a medium has detail: a voxel, or 1/64 of a medium without voxels.
double grain_of(const Medium& medium) {
    return medium.cell_size() > 0 ? medium.cell_size() : max_component(medium.bounds().size()) / 64;
}

}  // namespace

Vec3f ScatteredMarch::operator()(Ray ray, float jitter) {
    const auto hit = scene_.view.surfaces.intersect(ray, 0.5f, RayKind::Camera);
    if (hit) ray.t_max = hit->t;
    Gathered so_far;
    MediaWalk walk(scene_.media, ray);
    MediaRun run;
    while (walk.next(run)) {
        march_run(run, ray, jitter, so_far);
        // The reduced depth is the smaller one, unless light is scattered backwards.
        const Vec3f depth = min(so_far.depth, so_far.reduced_depth);
        if (max_component(dimmed(depth)) < cutoff) return so_far.radiance;
    }
    if (hit) {
        const ScatteredLight light = source_.on_surface(*hit);
        so_far.radiance += hit->albedo * (dimmed(so_far.reduced_depth) * light.reduced +
                                          dimmed(so_far.depth) * (light.plain - light.first));
    }
    return so_far.radiance;
}

void ScatteredMarch::march_run(const MediaRun& run, const Ray& ray, float jitter,
                               Gathered& so_far) {
    if (run.max == 0) return;
    const double length = run.t1 - run.t0;
    double steps = static_cast<double>(run.max) * length / params_.step_depth;
    for (const ActiveMedium& a : run.active) {
        steps = std::max(steps, length / (params_.step * grain_of(*a.medium)));
    }
    const int n = static_cast<int>(std::ceil(std::clamp(steps, 1.0, 1e5)));
    for (int i = 0; i < n; ++i) {
        const double t = run.t0 + (i + static_cast<double>(jitter)) * length / n;
        step(run, ray, t, static_cast<float>(length / n), so_far);
    }
}

void ScatteredMarch::step(const MediaRun& run, const Ray& ray, double t, float ds,
                          Gathered& so_far) {
    const Vec3d point = ray.at(t);
    Vec3f extinction, reduced_extinction, plain, reduced;
    for (const ActiveMedium& a : run.active) {
        ++lookups;
        const float density = a.density(t);
        if (!(density > 0)) continue;
        const CrossSections& cross = a.medium->cross_sections();
        const auto local = static_cast<float>(t - a.segment.anchor);
        const Vec3f color =
            a.medium->has_color() ? a.medium->color_at(a.segment, local, density) : Vec3f(1);
        const Vec3f scattering = density * cross.scattering * color;
        const auto kept = static_cast<float>(1 - mean_cosine(a.medium->phase()));
        extinction += density * cross.extinction();
        reduced_extinction += density * cross.extinction() - (1 - kept) * scattering;
        const ScatteredLight light = source_.in_medium(point, ray.direction, *a.medium);
        plain += scattering * (light.plain - kept * light.first);
        reduced += kept * scattering * light.reduced;
    }
    const Vec3f d = ds * extinction, reduced_d = ds * reduced_extinction;
    so_far.radiance += dimmed(so_far.depth) * source_length(d, ds) * plain +
                       dimmed(so_far.reduced_depth) * source_length(reduced_d, ds) * reduced;
    so_far.depth += d;
    so_far.reduced_depth += reduced_d;
}

}  // namespace gischt
