// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/path/dense_run.h"
#include "render/path/march_estimate.h"
#include "render/path/media_walk.h"
#include "render/path/path_params.h"
#include "render/path/spectral.h"

namespace gischt {

// Where a flight ended.
struct Collision {
    double t = 0;
    std::size_t medium = 0;  // index in the list of media; the one that scatters
    Vec3f color{1, 1, 1};    // of its scattering there
};

// Emission that a flight met.
struct GlowOnWay {
    double t = 0;
    std::size_t medium = 0;  // index in the list of media
    Vec3f radiance;          // times the weight, W/(m^2 sr)
};

// What trackers read and count. One per thread.
struct Tracker {
    std::span<const Medium* const> media;
    bool is_grey = true;  // all channels of all media have the same extinction
    bool is_emissive = false;
    int part = 0;  // of the shutter's time, to which the media belong
    std::int64_t lookups = 0;

    // Flies along a ray of unit direction until a collision with a medium, by null collisions
    // against the majorant of each 4^3 block (Woodcock et al. 1965); what lies below the block's
    // minimum needs no look-up (decomposition tracking, Kutz et al. 2017); where null collisions
    // pile up, cell by cell. False where the ray
    // leaves the media, or reaches t_max, first. The weight takes what depends on the channel; the
    // albedo stays for the caller (see scatter()). `hero` is the channel that decides. Emission on
    // the way is added to `emission`, where given, times the weight (in W/(m^2 sr)): the estimate
    // e / majorant at every tentative collision. Where `glows` is set, each is noted there too.
    bool fly(const Ray& ray, int hero, PathWeight& weight, RandomStream& random, Collision& end,
             Vec3f* emission = nullptr);
    std::vector<GlowOnWay>* glows = nullptr;

    // Transmittance along a ray of unit direction up to t_max per channel, unbiased (the exact one
    // deterministic), with the estimator asked for.
    Vec3f transmittance(const Ray& ray, TransmittanceEstimator estimator, RandomStream& random);

    // Optical depth per channel through all media, see exact_density_integral().
    Vec3f exact_depth(const Ray& ray);

  private:
    void meet_glow(const MediaRun& run, double t, const Vec3f& weight, Vec3f& emission);
    bool fly_by_cells(const MediaRun& run, double t, int hero, PathWeight& weight,
                      RandomStream& random, Collision& end, Vec3f* emission);
    bool choose_medium(const MediaRun& run, double t, int hero, float majorant, float u,
                       PathWeight& weight, Collision& end);
    Vec3f track_run(const MediaRun& run, const Vec3f& control, float majorant, float& depth_to_go,
                    RandomStream& random);
    Vec3f ratio_tracking(std::span<const Medium* const> tracked, const Ray& ray, bool with_control,
                         RandomStream& random);

    std::vector<RunCell> cells_;
    MarchEstimate march_;
};

// The estimator of shadow rays for which there is no cache.
inline TransmittanceEstimator shadow_estimator(const PathParams& params) {
    return params.shadow == TransmittanceEstimator::Cached ? TransmittanceEstimator::ResidualRatio
                                                           : params.shadow;
}

// Extinction of a run per channel at t, 1/m.
Vec3f extinction_at(const MediaRun& run, double t);

// Integral of the density of one medium along a ray of unit direction, metres: without error but
// rounding. Two Gauss points in each interpolation cell, in which the density is a cubic of t.
// Stops at an optical depth of 24 of the weakest channel that is not clear: exp(-24) = 4e-11.
double exact_density_integral(const Medium& medium, const Ray& ray, std::int64_t& lookups);

}  // namespace gischt
