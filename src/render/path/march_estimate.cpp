// SPDX-License-Identifier: Apache-2.0
#include "render/path/march_estimate.h"

#include <algorithm>
#include <cmath>

namespace gischt {
namespace {

// The chance of each finer level: a term's square falls with the steps by 2^-4 or faster, their
// cost grows by 2.
constexpr float finer = 0.25f;
constexpr int most_levels = 8;  // 512 times as many steps: their bias is below rounding

Vec3f negative_exponential(const Vec3f& depth) {
    return {std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)};
}

}  // namespace

void MarchEstimate::collect(std::span<const Medium* const> media, const Ray& ray) {
    stretches_.clear();
    active_.clear();
    reach_ = 0;
    MediaWalk walk(media, ray);
    MediaRun run;
    while (walk.next(run)) {
        if (!(run.max > 0)) continue;
        stretches_.push_back({run.t0, reach_, run.max, active_.size(), run.active.size()});
        active_.insert(active_.end(), run.active.begin(), run.active.end());
        reach_ += static_cast<float>(run.t1 - run.t0) * run.max;
    }
}

Vec3f MarchEstimate::extinction_at_place(float place, std::int64_t& lookups) const {
    auto after = std::upper_bound(stretches_.begin(), stretches_.end(), place,
                                  [](float x, const Stretch& s) { return x < s.begin; });
    const Stretch& s = after == stretches_.begin() ? *after : *--after;
    const double t = s.t0 + static_cast<double>((place - s.begin) / s.majorant);
    Vec3f extinction;
    for (std::size_t i = 0; i < s.count; ++i) {
        const ActiveMedium& a = active_[s.first + i];
        const double inside = std::min(t, a.segment.t1);
        extinction += a.density(inside) * a.medium->cross_sections().extinction();
    }
    lookups += static_cast<std::int64_t>(s.count);
    return extinction / Vec3f(s.majorant);
}

Vec3f MarchEstimate::transmittance(std::span<const Medium* const> media, const Ray& ray,
                                   float steps, RandomStream& random, std::int64_t& lookups) {
    collect(media, ray);
    if (!(reach_ > 0)) return Vec3f(1);
    // The level, by a geometric distribution.
    int level = 0;
    float chance = 1 - finer;
    for (float u = random.next() - chance; u >= 0 && level < most_levels; u -= chance) {
        chance *= finer;
        ++level;
    }
    if (level == most_levels) chance /= 1 - finer;  // all that is left
    const int coarse = 1 + static_cast<int>(std::min(steps * reach_, 4096.0f));
    const int parts = 2 << level, count = coarse * parts;
    const float offset = random.next();
    values_.clear();
    for (int i = 0; i < count; ++i) {
        const float place = (static_cast<float>(i) + offset) / static_cast<float>(count);
        values_.push_back(extinction_at_place(place * reach_, lookups));
    }
    // What every `stride`-th step gives.
    const auto estimate = [&](int first, int stride) {
        Vec3f sum;
        for (int i = first; i < count; i += stride) sum += values_[static_cast<std::size_t>(i)];
        return negative_exponential(
            sum * (reach_ * static_cast<float>(stride) / static_cast<float>(count)));
    };
    Vec3f coarsest;
    for (int i = 0; i < parts; ++i) coarsest += estimate(i, parts);
    coarsest = coarsest / Vec3f(static_cast<float>(parts));
    const Vec3f halves = 0.5f * (estimate(0, 2) + estimate(1, 2));
    return coarsest + (estimate(0, 1) - halves) * (1 / chance);
}

}  // namespace gischt
