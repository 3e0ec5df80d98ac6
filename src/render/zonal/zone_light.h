// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "optics/view.h"
#include "render/zonal/enclosure.h"
#include "render/zonal/scattered_source.h"
#include "render/zonal/zonal_params.h"

namespace gischt {

// The light of a view in equilibrium between zones of the box around its media, ready for the
// gather. Tells the job how many zones and how much memory that takes before it begins. Throws
// Error{Usage} when the zones are too thick, naming how many it would take.
std::unique_ptr<ScatteredSource> light_of_zones(const View& view, const Box3d& media,
                                                const ZonalParams& params, Job& job);

// Interpolates values of the patches of an enclosure on their surfaces: the mean of the patches
// around, weighed by how near they are and how they face.
class PatchInterpolation {
  public:
    explicit PatchInterpolation(const Enclosure& enclosure);
    Vec3f operator()(const SurfaceHit& hit, std::span<const Vec3f> values) const;

  private:
    const Enclosure& enclosure_;
};

}  // namespace gischt
