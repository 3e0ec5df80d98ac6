// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/random.h"
#include "math/pixel_sampler.h"
#include "math/vec.h"

namespace gischt {

// Where numbers come from that are not drawn but proposed, such as those of a Markov chain.
class NumberSource {
  public:
    virtual ~NumberSource() = default;
    virtual float next() = 0;  // in [0, 1)
    // A new part of the path; what comes does not depend on how many numbers the last one took.
    virtual void begin(std::size_t part) = 0;
};

// The random numbers of a path, a pure function of its keys: a stream without end, and stratified
// ones for the first turns and flights, which matter most.
struct RandomStream {
    std::uint64_t key = 0;
    std::uint32_t count = 0;
    PixelSampler sampler = {};
    std::uint32_t dimension = last_leading;  // the next stratified one
    static constexpr std::uint32_t last_leading = 10;
    NumberSource* source = nullptr;  // takes the place of all that

    // Another stream for something that happens at this point.
    RandomStream branch(std::uint64_t name) const { return {random_key(key, count, name)}; }

    float next() { return source ? source->next() : random_uniform(key, count++); }
    Vec2f two() {
        if (source) {
            const float first = source->next();
            return {first, source->next()};
        }
        const std::uint64_t bits = mix64(key + 0x9e3779b97f4a7c15ULL * ++count);
        return {static_cast<float>(bits >> 40) * 0x1p-24f,
                static_cast<float>(bits >> 8 & 0xffffff) * 0x1p-24f};
    }
    // For a turn and for a flight.
    float leading() { return dimension < last_leading ? sampler.one(dimension++) : next(); }
    Vec2f leading_two() { return dimension < last_leading ? sampler.two(dimension++) : two(); }
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
