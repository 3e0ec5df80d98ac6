// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "optics/medium.h"

namespace gischt {

// Most media that a ray may be in at once.
inline constexpr std::size_t most_media = 16;

// A medium that a run lies in; `index` is its place in the list that was walked.
struct ActiveMedium {
    const Medium* medium = nullptr;
    std::size_t index = 0;
    MediumSegment segment;

    // Density at t along the ray.
    float density(double t) const {
        return medium->density_at(segment, static_cast<float>(t - segment.anchor));
    }
};

// A stretch of a ray in which the set of media is constant, with bounds of the extinction of the
// strongest channel, 1/m, summed over the media.
struct MediaRun {
    double t0 = 0, t1 = 0;
    float min = 0, mean = 0, max = 0;
    float emission_max = 0;  // bound of a L_e of the strongest channel, W/(m^3 sr)
    std::span<const ActiveMedium> active;
};

// The runs of a ray of unit direction through several media that may overlap, in ascending order.
// Stretches without medium are left out. The media must outlive the walk, and a run's `active`
// holds until the next call.
class MediaWalk {
  public:
    MediaWalk(std::span<const Medium* const> media, const Ray& ray,
              BrickGrain grain = BrickGrain::Blocks);
    MediaWalk(const MediaWalk&) = delete;
    MediaWalk& operator=(const MediaWalk&) = delete;

    bool next(MediaRun& run);

  private:
    struct Walker {
        SegmentWalk walk;
        MediumSegment segment;
    };
    bool next_of_one(MediaRun& run);
    static void advance(Walker& walker);

    std::span<const Medium* const> media_;
    double t_, t_end_;
    std::optional<SegmentWalk> only_;  // of a single medium
    ActiveMedium one_;
    std::vector<Walker> walkers_;  // of several
    std::vector<ActiveMedium> active_;
};

}  // namespace gischt
