// SPDX-License-Identifier: Apache-2.0
#include "optics/medium_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gischt {
namespace {

// Sum of the density over one segment times its length, in t.
double segment_integral(const Medium& medium, const MediumSegment& s, double step_t,
                        std::int64_t* lookups) {
    const double length = s.t1 - s.t0;
    constexpr int most = 32;  // a brick's diagonal is 14 cells
    const int n = std::clamp(static_cast<int>(std::ceil(length / step_t)), 1, most);
    std::array<float, most> t, density;
    const double ds = length / n;
    for (int i = 0; i < n; ++i) {
        t[static_cast<std::size_t>(i)] = static_cast<float>(s.t0 - s.anchor + (i + 0.5) * ds);
    }
    const auto count = static_cast<std::size_t>(n);
    medium.densities(s, {t.data(), count}, density.data());
    if (lookups) *lookups += n;
    float sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += density[i];
    return static_cast<double>(sum) * ds;
}

}  // namespace

float density_integral(const Medium& medium, const Ray& ray, const DepthSteps& steps,
                       std::int64_t* lookups) {
    const double per_t = length(ray.direction);  // metres
    const double cell = medium.cell_size();
    const double step_t = steps.step * cell / per_t;
    const float strength = medium.strength();
    if (strength == 0) return 0;
    float weakest = strength;
    const Vec3f extinction = medium.cross_sections().extinction();
    for (int c = 0; c < 3; ++c) {
        if (extinction[c] > 0) weakest = std::min(weakest, extinction[c]);
    }
    const double enough = static_cast<double>(steps.enough) / static_cast<double>(weakest);
    SegmentWalk walk = medium.segments(ray, BrickGrain::Bricks);
    MediumSegment s;
    double sum = 0;
    while (walk.next(s)) {
        if (s.max == 0) continue;
        sum += per_t * (s.min == s.max ? static_cast<double>(s.mean / strength) * (s.t1 - s.t0)
                                       : segment_integral(medium, s, step_t, lookups));
        if (sum > enough) break;
    }
    return static_cast<float>(sum);
}

Vec3f optical_depth(std::span<const std::shared_ptr<const Medium>> media, const Ray& ray,
                    const DepthSteps& steps, std::int64_t* lookups) {
    Vec3f sum;
    for (const auto& medium : media) {
        sum +=
            density_integral(*medium, ray, steps, lookups) * medium->cross_sections().extinction();
    }
    return sum;
}

void densities_on_line(const Medium& medium, const Ray& ray, double t0, double dt,
                       std::span<float> out) {
    std::fill(out.begin(), out.end(), 0.0f);
    const auto count = static_cast<double>(out.size());
    // A margin of half a step, so that the ends do not fall out by rounding.
    SegmentWalk walk = medium.segments(
        {ray.origin, ray.direction, t0 - 0.5 * dt, t0 + (count - 0.5) * dt}, BrickGrain::Bricks);
    MediumSegment s;
    std::array<float, 32> t;
    while (walk.next(s)) {
        auto i = static_cast<std::size_t>(std::clamp(std::ceil((s.t0 - t0) / dt), 0.0, count));
        const auto end =
            static_cast<std::size_t>(std::clamp(std::ceil((s.t1 - t0) / dt), 0.0, count));
        while (i < end) {
            const std::size_t n = std::min(end - i, t.size());
            for (std::size_t k = 0; k < n; ++k) {
                t[k] = static_cast<float>(t0 + static_cast<double>(i + k) * dt - s.anchor);
            }
            medium.densities(s, {t.data(), n}, out.data() + i);
            i += n;
        }
    }
}

}  // namespace gischt
