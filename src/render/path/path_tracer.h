// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "math/pixel_sampler.h"
#include "optics/interior.h"
#include "render/path/angle_sampler.h"
#include "render/path/path_scene.h"
#include "render/path/ray_profile.h"

namespace gischt {

// What a camera ray sees, in W/(m^2 sr) where it is radiance.
struct TracedRay {
    Vec3f radiance;  // the background included
    float alpha = 0;
    float depth = 0, opacity = 0;  // sum of opacity times distance, and what to divide it by
    // Parts of the radiance: scattered once, more often, not at all but from something that glows.
    Vec3f direct, indirect, emission;
    Vec3f albedo, normal;         // of the first scattering, times the opacity
    Vec2f motion;                 // of the same, in pixels per frame, where asked for
    Vec3f transmittance;          // of what lies in front of the background
    std::vector<Vec3f> of_light;  // by index in view.lights, where asked for
};

// Where light is scattered: a point of a medium, or of a surface.
struct Scatterer {
    Vec3d point;
    Vec3f forward;                   // direction in which the path came
    const Medium* medium = nullptr;  // or
    const SurfaceHit* hit = nullptr;
    const Bsdf* bsdf = nullptr;

    // The phase function in 1/sr, or the scattering function times the cosine.
    Vec3f value(const Vec3d& direction) const;
    // The density with which a new direction is drawn, 1/sr.
    float pdf(const Vec3d& direction) const;
    // Nothing where the sample would carry no light.
    std::optional<BsdfSample> sample(Vec2f u, RandomStream& random) const;
    Ray leave(const Vec3d& direction, double distance) const;
};

// What another method finds of the light that the camera's rays meet before their first scattering.
// With one the path tracer follows light only straight from its sources to that first scattering,
// and leaves the rest to it.
class EyeGather {
  public:
    virtual ~EyeGather() = default;
    // W/(m^2 sr), scattered once and more often.
    struct Light {
        Vec3f once, more;
    };
    // What comes to the origin of a ray from [0, t_max], in which these media are; the profile is
    // the ray's.
    virtual Light along(const Ray& ray, const RayProfile& profile,
                        std::span<const Medium* const> media, RandomStream random) = 0;
    // What a surface sends to `out`.
    virtual Light at(const SurfaceHit& hit, const Bsdf& bsdf, const Vec3d& out) = 0;
};

// Follows paths through a scene; keeps scratch memory, so one per thread.
class PathTracer {
  public:
    // `depth`: most scattering events of a path; mirrors and refractions of smooth surfaces are not
    // counted.
    PathTracer(const PathScene& scene, int depth, bool separates_lights);

    // Fills `motion`. The view must know the cameras around its frame.
    void show_motion() { shows_motion_ = true; }
    // Must outlive the tracer; for a depth of 1 at most.
    void leave_rest_to(EyeGather* gather) { gather_ = gather; }

    const TracedRay& operator()(const Ray& ray, float moment, const PixelSampler& sampler);

    std::int64_t rays() const { return rays_; }
    std::int64_t lookups() const { return tracker_.lookups; }

  private:
    // The state of a path between two scatterings.
    struct Leg {
        Ray ray;
        PathWeight weight;
        float start = 1;  // the weight with which the path set out
        int events = 0;   // scatterings so far
        int mirrors = 0;  // delta scatterings of surfaces so far
        Vec3d from;       // the last scattering that was none of these
        float pdf = 0;    // of the direction from there by what scatters, 1/sr; 0: it was a mirror
        float sky_chance = 1;  // with which a sky was looked for there
        float glow = 0;        // of the direction in EmissionSampler, were there no surfaces, 1/sr
        // The scatterings in succession by one medium up to here (see sun_bridge.cpp).
        const Medium* run_in = nullptr;
        int run = 0;
        float credit = 0;  // towards the next bridge
    };
    // Turns that end in the direction of a sun.
    struct Chain {
        std::size_t turns = 0;                                   // before the last one
        std::array<PhaseLobes::Lobe, PhaseLobes::longest> lobe;  // of each
        std::array<float, PhaseLobes::longest + 1> rest;  // mean cosine of those from here on
        LightSample sun;
        float value = 0;  // of all turns together, 1/sr
    };
    enum class End { Infinity, Surface, Collision };

    void see(Leg leg, const PixelSampler& sampler);
    void see_surface(const Leg& leg, const SurfaceHit& hit, const PixelSampler& sampler);
    bool see_both_ways(const Leg& leg, const SurfaceHit& hit, RandomStream random);
    PixelSampler numbers_behind(const Leg& leg) const;
    void see_through(const Leg& leg, const PixelSampler& sampler);
    float profile_share(double t) const;
    void see_places(const Leg& leg, const PixelSampler& sampler);
    bool shows(const Leg& leg, const SurfaceHit& hit, RandomStream& random);
    void note_first(float share, const Scatterer& at, const Vec3f& albedo, const Vec3f& normal);
    Vec2f motion_of(const Scatterer& at) const;

    void follow(Leg leg, RandomStream& random);
    End fly(Leg& leg, RandomStream& random, Collision& collision, std::optional<SurfaceHit>& hit);
    End look(Leg& leg, RandomStream& random, std::optional<SurfaceHit>& hit);
    bool scatter_in_medium(Leg& leg, const Collision& collision, RandomStream& random);
    bool scatter_at_surface(Leg& leg, const SurfaceHit& hit, RandomStream& random);
    bool go_on(const Scatterer& at, Leg& leg, RandomStream& random);
    std::optional<BsdfSample> turn(const Scatterer& at, Leg& leg, RandomStream& random);
    static void count_run(Leg& leg, const Medium* medium);
    bool survives(Leg& leg, RandomStream& random) const;

    // `local_share`: of the light from finite places, the rest being found in another way.
    void direct_light(const Scatterer& at, const Leg& leg, RandomStream& random,
                      float local_share = 1);
    void from_sun(const SunSource& sun, const Scatterer& at, const Leg& leg, RandomStream& random);
    Vec3f sunlight(const SunSource& sun, const Scatterer& at, const LightSample& s,
                   RandomStream& random);
    void from_local(const Scatterer& at, const Leg& leg, RandomStream& random);
    float sky_chance(const Scatterer& at) const;
    void from_broad(const Scatterer& at, const Leg& leg, RandomStream& random);
    void from_infinity(const Leg& leg, const Vec3f& transmittance);
    void from_surface(const Leg& leg, const SurfaceHit& hit, const Vec3f& transmittance);

    Vec3d way_to_glow(const Scatterer& at, RandomStream& random) const;
    float lean_to_glow(const Scatterer& at) const;
    void from_glow(const Scatterer& at, const Leg& leg, RandomStream& random);
    float glow_share(const Leg& leg, bool is_cut) const;

    bool has_bridges(const Medium& medium) const;
    void set_out_bridges(const Scatterer& at, Leg& leg, RandomStream random);
    static Chain chain_of(const Scatterer& at, const SunSource& sun, int turns,
                          RandomStream& random);
    void bridge(const Scatterer& at, Leg leg, const SunSource& sun, const Chain& chain,
                float factor, RandomStream& random);
    bool take_flight(Leg& leg, const Medium& medium, RandomStream& random);

    float missed_light(const Scatterer& at, RandomStream& random);

    Vec3f shadow(const Scatterer& at, const Ray& ray, RandomStream& random);
    bool is_blocked(const Ray& ray) const { return scene_.view.surfaces.is_blocked(ray, moment_); }
    std::optional<SurfaceHit> intersect(const Ray& ray, RayKind kind = RayKind::Other) {
        ++rays_;
        return scene_.view.surfaces.intersect(ray, moment_, kind);
    }
    // The camera's own view, in which some surfaces do not appear.
    static RayKind kind_of(const Leg& leg) {
        return leg.events == 0 && leg.mirrors == 0 ? RayKind::Camera : RayKind::Other;
    }
    // Passes a boundary; `inside_` decides which media the tracker sees.
    void cross(const SurfaceHit& hit);
    void take_media();
    bool passes(const SurfaceHit& hit) const;

    void gather_along(const Leg& leg, const RayProfile& profile, const RandomStream& random);
    void gather_at(const Leg& leg, const SurfaceHit& hit, const Bsdf& bsdf);
    // Adds light that was scattered `events` times.
    void deposit(const Vec3f& radiance, int events, int light = -1);
    // The same of light that something on the path gave off itself.
    void deposit_glow(const Vec3f& radiance, int events);

    const PathScene& scene_;
    int depth_;
    bool shows_motion_ = false;
    EyeGather* gather_ = nullptr;
    int hero_ = 0;
    float moment_ = 0.5f;
    Ray camera_ray_;
    PixelSampler sampler_;                 // of the sample
    std::optional<InteriorStack> inside_;  // only where surfaces have an inside
    const Medium* interior_ = nullptr;
    Tracker tracker_;
    RayProfile profile_, glow_profile_;
    AngleSampler angles_;
    std::vector<ProfilePoint> points_;
    TracedRay result_;
    std::int64_t rays_ = 0;
};

}  // namespace gischt
