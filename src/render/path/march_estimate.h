// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/path/media_walk.h"
#include "render/path/spectral.h"

namespace gischt {

// Transmittance from even steps along a ray, freed of the bias that exp of a noisy optical depth
// has, by one random term of the telescoping sum over ever finer steps (Misso et al. 2022,
// "Unbiased and consistent rendering using biased estimators"). A term is what 2 n steps give minus
// the mean of what each half of them gives by itself (antithetic, Giles & Szpruch 2014), so that
// errors cancel to second order, and all steps serve the coarsest estimate as well. Steps are even
// in the optical depth of the blocks' majorants, so that none is lost in the void. May be negative
// or above 1 where the steps are too few, without harm to the mean. Keeps its memory from ray to
// ray; one per thread.
class MarchEstimate {
  public:
    // `steps` per unit of the majorants' optical depth, of the coarsest estimate; at least one and
    // at most 4096.
    Vec3f transmittance(std::span<const Medium* const> media, const Ray& ray, float steps,
                        RandomStream& random, std::int64_t& lookups);

  private:
    struct Stretch {
        double t0 = 0;
        float begin = 0, majorant = 0;  // optical depth of the majorants before it; 1/m
        std::size_t first = 0, count = 0;
    };
    void collect(std::span<const Medium* const> media, const Ray& ray);
    Vec3f extinction_at_place(float place, std::int64_t& lookups) const;

    std::vector<Stretch> stretches_;
    std::vector<ActiveMedium> active_;
    std::vector<Vec3f> values_;  // of the steps: extinction over its majorant
    float reach_ = 0;            // optical depth of the majorants
};

}  // namespace gischt
