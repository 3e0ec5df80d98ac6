// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/pixel_sampler.h"
#include "render/march/deep_march.h"
#include "render/march/march_scene.h"

namespace gischt {

// What a camera ray sees.
struct MarchedRay {
    Vec3f radiance;                // W/(m^2 sr), without the background
    Vec3f transmittance{1, 1, 1};  // of what lies behind; 0 where a surface was hit
    float depth = 0;               // sum of opacity times distance
    float opacity = 0;             // what that sum is divided by
};

// Marches rays through a scene; keeps scratch memory, so one per thread.
class RayMarcher {
  public:
    explicit RayMarcher(const MarchScene& scene);

    // Eq. 19 front to back up to the nearest surface, which is shaded, or to the end of the media;
    // eq. 20 where the scene's depth is above 1.
    MarchedRay operator()(const Ray& ray, const PixelSampler& sampler);

    std::int64_t rays() const { return rays_ + deep_.rays; }
    std::int64_t lookups() const { return lookups_ + deep_.lookups; }

  private:
    static constexpr std::size_t batch = 16;

    struct Walker {
        SegmentWalk walk;
        MediumSegment segment;
        std::size_t medium = 0;
        bool is_active = false;
        std::array<float, batch> density{};
        std::array<Vec3f, batch> emission{};
        std::array<Vec3f, batch> scattering{};  // where the medium has colours

        // After the last segment there is one at infinity.
        void advance() {
            constexpr double never = std::numeric_limits<double>::infinity();
            if (!walk.next(segment)) segment.t0 = segment.t1 = never;
        }
    };

    void prepare_lights(const Ray& ray, const PixelSampler& sampler);
    void march_interval(const Ray& ray, double t0, double t1, const PixelSampler& sampler);
    void march_batch(const Ray& ray, std::span<const double> t, double dt, float jitter,
                     const PixelSampler& sampler);
    void scatter(const Ray& ray, const Vec3d& point, std::size_t i, const Vec3f& gain,
                 const PixelSampler& sampler);
    Vec3f in_scattered(std::size_t medium, const Ray& ray, const Vec3d& point,
                       const PixelSampler& sampler);
    Vec3f from_narrow(std::size_t medium, std::size_t light, const Ray& ray, const Vec3d& point);
    Vec3f from_broad(std::size_t medium, const Ray& ray, const Vec3d& point,
                     const PixelSampler& sampler);
    Vec3f shade(const SurfaceHit& hit, const PixelSampler& sampler);
    // Irradiance of a sky at a point of a surface: what arrives of it, and if nothing blocked it.
    struct SkyEstimate {
        Vec3f arriving, open;
    };
    Vec3f sky_irradiance(std::size_t broad, const SurfaceHit& hit, const PixelSampler& sampler);
    SkyEstimate estimate_sky(std::size_t broad, const SurfaceHit& hit, Vec2f first);
    Vec3f through_media(const Ray& ray, double step);

    const MarchScene& scene_;
    std::vector<Walker> walkers_;
    std::vector<float> phase_weight_;  // contribution * phase by octave, medium and infinite light
    std::vector<std::size_t> phase_offset_;  // of a medium in there, for light 0
    std::size_t phase_stride_ = 0;           // from light to light
    std::vector<LightSample> sun_;           // of this ray, by narrow light: a point of its disc
    std::vector<float> local_weight_;        // the same for one light at a finite place
    std::vector<AimedSky> sky_;              // by broad light; empty without surfaces
    std::uint32_t step_ = 0;                 // steps done on this ray
    DeepMarch deep_;                         // light that was scattered before, and where
    GatherPlaces gathers_{0, 0};             // it is gathered on this ray
    MarchedRay result_;
    std::int64_t rays_ = 0, lookups_ = 0;
};

}  // namespace gischt
