// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "optics/light.h"
#include "optics/sun_depth.h"
#include "render/path/path_params.h"
#include "render/path/tracking.h"

namespace gischt {

// A light at infinity that comes from (nearly) one direction: a sun.
struct SunSource {
    const Light* light = nullptr;
    int index = -1;   // in view.lights
    Vec3d direction;  // unit, towards its centre
    // Optical depth towards it per unit of cross section, by part of the shutter's time, then by
    // medium; empty without cache.
    std::vector<std::shared_ptr<const SunDepth>> depth;

    bool is_cached() const { return !depth.empty(); }
};

// How deep a point lies in the shadow of the media, for light that forward scattering carries on
// its way: the sum of their optical depths (strongest channel) towards the sun times 1 - |mean
// cosine|, from the cache, 0 where there is none. A guide, not an estimate.
float forward_depth(const SunSource& sun, const Vec3d& point, const Tracker& tracker);

// The transmittance from a point to a sun along `towards` (a direction within its disc), without
// bias: from the cache that it must have, and with some chance p the exact one minus the cached one
// over p. The chance follows what may be wrong: nothing of the light arrives, or next to all of it.
Vec3f sun_transmittance(const SunSource& sun, const Vec3d& point, const Vec3d& towards,
                        const PathParams& params, Tracker& tracker, RandomStream& random);

}  // namespace gischt
