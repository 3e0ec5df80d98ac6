// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/job.h"
#include "optics/emission_sampler.h"
#include "optics/surface_light.h"
#include "optics/view.h"
#include "render/path/path_params.h"
#include "render/path/sun_source.h"

namespace gischt {

struct Field;  // grid/frame.h

// A view made ready for path tracing.
struct PathScene {
    // Throws Error{Usage} where the view asks for what the method cannot do.
    // `meets_all`: the method finds lights without size behind glass.
    PathScene(const View& the_view, const PathParams& the_params, Job& job, bool meets_all = false);

    const View& view;
    const PathParams& params;
    std::vector<const Medium*> media;  // those that fill no surface, amid the shutter's time
    bool is_grey = true;               // all channels of all media have the same extinction
    bool is_emissive = false;          // a medium glows
    bool has_interiors = false;        // a surface has an inside
    int surface_splits = 1;            // of the parameters, or as it suits the media

    // A light that is one of many to be drawn from.
    struct Drawn {
        const Light* light = nullptr;
        int index = -1;  // in view.lights; -1 for a surface
    };
    std::vector<SunSource> suns;       // reached by sampling them only
    std::vector<Drawn> local;          // at finite places
    std::vector<const Light*> placed;  // those of them that have a place
    std::vector<Drawn> broad;          // at infinity, sampled and met by chance
    float sky_chance = 1;              // with which these are looked for at a point of a medium
    std::vector<Drawn> even;           // the same from everywhere: met by chance only
    EmissionSampler glow;              // media that glow; empty where surfaces have insides
    // By surface: the light that it is, null where it cannot be sampled.
    std::vector<const SurfaceLight*> surface_light;

    // Parts of the shutter's time in which media differ (1: they stand still), that of a moment,
    // and what it makes of `media` and of a medium that fills a surface.
    int parts() const { return static_cast<int>(moving_.size()); }
    int part_of(float moment) const {
        return std::min(static_cast<int>(moment * static_cast<float>(parts())), parts() - 1);
    }
    std::span<const Medium* const> media_in(int part) const {
        return moving_[static_cast<std::size_t>(part)];
    }
    const Medium* medium_in(int part, const Medium* middle) const;
    // The velocity of what a medium is made of, m/s; null where none is known.
    const Field* velocity_of(const Medium* medium) const {
        const auto found = velocity_.find(medium);
        return found == velocity_.end() ? nullptr : found->second;
    }

    // Chance with which a light at a finite place is drawn at a point, in proportion to how
    // brightly it would shine there.
    float local_share(const Light& light, const Vec3d& point) const;

  private:
    void take_motion();
    void sort_lights(Job& job);
    void refuse_what_none_can_meet() const;
    float chance_of_skies() const;
    void make_grids(SunSource& sun, Job& job) const;

    std::vector<std::vector<const Medium*>> moving_;  // by part; as long as media each
    std::unordered_map<const Medium*, const Field*> velocity_;
};

}  // namespace gischt
