// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "math/pixel_sampler.h"
#include "render/path/path_scene.h"
#include "render/path/ray_profile.h"

namespace gischt {

// What a camera ray sees.
struct TracedRay {
    Vec3f radiance;  // W/(m^2 sr), the background included
    float alpha = 0;
    float depth = 0, opacity = 0;  // sum of opacity times distance, and what to divide it by
};

// Follows paths through a scene; keeps scratch memory, so one per thread.
class PathTracer {
  public:
    PathTracer(const PathScene& scene, int depth);

    TracedRay operator()(const Ray& ray, const PixelSampler& sampler);

    std::int64_t rays() const { return rays_; }
    std::int64_t lookups() const { return tracker_.lookups; }

  private:
    // A place in a medium at which light is scattered.
    struct Vertex {
        Vec3d point;
        Vec3f forward;  // direction in which the path came
        std::size_t medium = 0;
        PathWeight weight;  // the albedo of this scattering included
        int events = 1;     // scatterings up to and including this one
        // The direction was drawn from this medium's phase function with this density, and suns are
        // also reached by halos; null at the first vertex.
        const Medium* halo_of = nullptr;
        float phase_pdf = 0;
    };
    // Where a path meets a surface.
    struct Bounce;

    void see_through_profile(const Ray& ray, const PixelSampler& sampler, TracedRay& result);
    void see_by_tracking(const Ray& ray, const std::optional<SurfaceHit>& hit,
                         const PixelSampler& sampler, TracedRay& result);
    Vec3f seen_behind(const Ray& ray, const std::optional<SurfaceHit>& hit, RandomStream& random,
                      float& alpha);

    // Light that reaches the vertex from the vertex on, after the vertex' own direct light.
    Vec3f follow(Vertex vertex, RandomStream& random);
    Vec3f follow_surface(const SurfaceHit& hit, const Vec3f& forward, PathWeight weight, int events,
                         RandomStream& random);
    bool survives(PathWeight& weight, RandomStream& random) const;

    Vec3f direct_light(const Vertex& vertex, RandomStream& random);
    Vec3f from_sun(const SunSource& sun, const Vertex& vertex, RandomStream& random);
    Vec3f from_local(const Vertex& vertex, RandomStream& random);
    Vec3f from_broad(const Vertex& vertex, RandomStream& random);
    Vec3f from_halo(const Vertex& vertex, RandomStream random);
    Vec3f from_infinity(const Vec3d& direction, float pdf) const;

    Vec3f transmittance(const Ray& ray, RandomStream& random);
    bool is_blocked(const Ray& ray) const { return scene_.view.surfaces.is_blocked(ray); }
    bool has_halo(const Medium& medium) const;

    const PathScene& scene_;
    int depth_;
    int hero_ = 0;
    Tracker tracker_;
    RayProfile profile_;
    std::vector<ProfilePoint> points_;
    std::int64_t rays_ = 0;
};

}  // namespace gischt
