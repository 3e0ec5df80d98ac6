// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "render/bdpt/bdpt_scene.h"
#include "render/bdpt/path_vertex.h"
#include "render/path/tracking.h"

namespace gischt {

// A path from one end, with what lights it met on its way.
struct Subpath {
    std::vector<PathVertex> vertices;

    // Emission of media met on the flight from a vertex.
    struct Glow {
        std::size_t from = 0;
        Vec3d point;
        const Medium* medium = nullptr;
        Vec3f radiance;      // that the camera receives, W/(m^2 sr)
        double through = 1;  // about the transmittance from the vertex
    };
    std::vector<Glow> glows;

    // The path left the scene from its last vertex.
    struct Escape {
        Vec3d direction;
        PathWeight weight;
        double through = 1;
    };
    std::optional<Escape> escape;

    void clear() {
        vertices.clear();
        glows.clear();
        escape.reset();
    }
    std::span<const PathVertex> first(std::size_t count) const { return {vertices.data(), count}; }
};

// Where the numbers of a light path's start come from.
struct LightNumbers {
    float choice = 0, extra = 0;
    Vec2f place, direction;
};

// Traces subpaths and connections. One per thread.
class SubpathTracer {
  public:
    // `depth`: most scatterings, those into single directions left out.
    SubpathTracer(const BdptScene& scene, int depth);

    // How far a subpath goes.
    struct Length {
        std::size_t most_vertices = 1'000'000;
        bool has_roulette = true;
    };
    // From the camera along a ray. `density`: of its direction (1/sr) or place (1/m^2), the whole
    // film counting 1.
    void from_camera(const Ray& ray, double density, int hero, RandomStream& random,
                     const Length& length, Subpath& path);
    // From a light; empty where none was drawn. `random` serves the steps after the start.
    void from_light(const LightNumbers& start, int hero, RandomStream& random, const Length& length,
                    Subpath& path);

    // Whether light passes between a vertex and what lies along `ray` (which leaves the vertex) up
    // to its t_max; with `target` (a surface) up to that surface, which is then told in `reached`.
    struct Passage {
        bool is_open = false;
        bool has_boundaries = false;        // that change the medium on the way
        double through = 1;                 // about the transmittance; for weights
        std::optional<SurfaceHit> reached;  // the target
    };
    Passage passage(const PathVertex& v, const Ray& ray, RayKind kind, int target = -1);
    // The transmittance of an open passage up to ray.t_max, unbiased.
    Vec3f transmittance(const PathVertex& v, const Ray& ray, const Passage& passage,
                        RandomStream& random);

    // The ray from a vertex in a direction.
    static Ray leave(const PathVertex& v, const Vec3d& direction);

    std::int64_t rays() const { return rays_; }
    std::int64_t lookups() const { return tracker_.lookups; }

  private:
    // The state of a subpath between two vertices.
    struct Leg {
        PathFrom from = PathFrom::Camera;
        Ray ray;
        PathWeight weight;
        int hero = 0, events = 0, deltas = 0;
        float start = 1;     // the weight with which the path set out
        double through = 1;  // since the last vertex
        double density = 0;  // of the direction, 1/sr; of the place where `is_place`
        bool is_place = false;
    };
    void walk(Leg leg, RandomStream& random, const Length& length, Subpath& path);
    bool step(Leg& leg, RandomStream& random, const Length& length, Subpath& path);
    bool fly(Leg& leg, RandomStream& random, Subpath& path, PathVertex& next);
    void note_glows(const Leg& leg, Subpath& path);
    bool turn(Leg& leg, RandomStream& random, const Length& length, Subpath& path);
    void finish_light_start(Subpath& path);
    bool place_density(const Leg& leg, const Subpath& path, PathVertex& next) const;
    bool survives(Leg& leg, RandomStream& random) const;

    std::optional<SurfaceHit> intersect(const Ray& ray, RayKind kind) {
        ++rays_;
        return scene_.view.surfaces.intersect(ray, 0.5f, kind);
    }
    bool passes(const SurfaceHit& hit) const;
    void cross(const SurfaceHit& hit);
    void enter(const std::optional<InteriorStack>& inside);
    void take_media();
    double relative_ior(const SurfaceHit& hit) const;
    double expected_transmittance(const Ray& ray);

    const BdptScene& scene_;
    int depth_;
    std::optional<InteriorStack> inside_;  // only where surfaces have an inside
    const Medium* interior_ = nullptr;
    Tracker tracker_;
    std::vector<GlowOnWay> met_;
    std::int64_t rays_ = 0;
};

}  // namespace gischt
