// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/random.h"
#include "math/vec.h"

namespace gischt {

// A stream of random numbers without end, a pure function of its key. A few numbers from elsewhere
// (stratified ones) may lead it.
struct RandomStream {
    std::uint64_t key = 0;
    std::uint32_t count = 0;
    std::uint32_t leading = 0;  // numbers of lead_ still to come
    Vec2f lead_[2] = {};

    // The next two calls of two() or next() give these.
    void lead(Vec2f first, Vec2f second) {
        lead_[0] = second;
        lead_[1] = first;
        leading = 2;
    }
    // Another stream for something that happens at this point.
    RandomStream branch(std::uint64_t name) const { return {random_key(key, count, name)}; }
    float next() {
        if (leading > 0) return lead_[--leading].x;
        return random_uniform(key, count++);
    }
    Vec2f two() {
        if (leading > 0) return lead_[--leading];
        const std::uint64_t bits = mix64(key + 0x9e3779b97f4a7c15ULL * ++count);
        return {static_cast<float>(bits >> 40) * 0x1p-24f,
                static_cast<float>(bits >> 8 & 0xffffff) * 0x1p-24f};
    }
};

// The weight of a path in three channels. Distances are drawn in one of them, the hero, and the
// estimate is that of the balance heuristic over the three choices of the hero (Wilkie et al. 2014,
// "Hero wavelength spectral sampling"; Miller, Georgiev, Jarosz 2019 for null collisions): a
// contribution counts weight / mean(rate), which never exceeds 3 times the integrand over the
// largest density. In grey media rate stays (1, 1, 1).
struct PathWeight {
    Vec3f weight{1, 1, 1};  // integrand / density of the path with this hero
    Vec3f rate{1, 1, 1};    // density of the path with each hero / with this one

    Vec3f value() const { return weight * (3 / (rate.x + rate.y + rate.z)); }
};

}  // namespace gischt
