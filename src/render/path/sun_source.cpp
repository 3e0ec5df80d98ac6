// SPDX-License-Identifier: Apache-2.0
#include "render/path/sun_source.h"

#include <algorithm>

#include "math/fast_math.h"

namespace gischt {

float forward_depth(const SunSource& sun, const Vec3d& point, const Tracker& tracker) {
    float depth = 0;
    const std::size_t first = static_cast<std::size_t>(tracker.part) * tracker.media.size();
    for (std::size_t m = 0; m < tracker.media.size() && sun.is_cached(); ++m) {
        const Medium& medium = *tracker.media[m];
        const auto& cache = sun.depth[first + m];
        if (!cache) continue;
        depth += (*cache)(point)*medium.strength() * (1 - medium.phase_lobes().mean_turn);
    }
    return depth;
}

Vec3f sun_transmittance(const SunSource& sun, const Vec3d& point, const Vec3d& towards,
                        const PathParams& params, Tracker& tracker, RandomStream& random) {
    const Ray ray{point, towards};
    Vec3f depth, doubt;
    const std::size_t first = static_cast<std::size_t>(tracker.part) * tracker.media.size();
    for (std::size_t m = 0; m < tracker.media.size(); ++m) {
        const Medium& medium = *tracker.media[m];
        const Vec3f extinction = medium.cross_sections().extinction();
        if (const auto& cache = sun.depth[first + m]) {
            const SunDepth::Found found = cache->find(point);
            depth += found.depth * extinction;
            doubt += found.range * extinction;
        } else {
            depth += static_cast<float>(exact_density_integral(medium, ray, tracker.lookups)) *
                     extinction;
        }
    }
    const Vec3f cached = tracker.is_grey
                             ? Vec3f(fast_exp(-depth.x))
                             : Vec3f(fast_exp(-depth.x), fast_exp(-depth.y), fast_exp(-depth.z));
    // The error of exp(-depth) is that of the depth times exp(-depth), and the former grows with
    // the depth: least in full light and in deep shadow. A tenth of the chance remains everywhere.
    const float largest = max_component(cached);
    const auto most = static_cast<float>(params.correction);
    float chance = most * std::clamp(4 * largest * (1 - largest), 0.1f, 1.0f);
    // An exact transmittance below (1 - chance) times the cached one makes the result negative.
    // Depths are nearly always wrong by less than half of the range that they were interpolated
    // from; where that is a good part of 1 the medium is so dense that the exact one costs little.
    chance = std::clamp(max_component(doubt) - 0.5f, chance, 1.0f);
    if (random.next() >= chance) return cached;
    const Vec3f exact = tracker.transmittance(ray, TransmittanceEstimator::Exact, random);
    return cached + (exact - cached) * (1 / chance);
}

}  // namespace gischt
