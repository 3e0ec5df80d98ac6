// SPDX-License-Identifier: Apache-2.0
// Suns reached through chains of scatterings that end in their direction.
//
// In media that scatter forward, p(turn towards the sun) is a peak that few paths hit: they
// sparkle. But the light of a sun that was scattered n times by the same medium does not depend on
// the directions between so sharply: its law is a Henyey-Greenstein function of g^n, whatever
// happens on the way. So a bridge draws its directions by the law of a chain of turns whose first
// and last direction are known (sample_between), its flights as ever, and its value is that smooth
// function times the sun's transmittance at its end.
//
// Each scattering is reached in one way only. Of those in succession by one medium (a run) the
// first sees suns directly, the next ones through shorter bridges from the first, and all others
// through bridges over `memory` turns from the one so many before.
#include <algorithm>
#include <array>
#include <utility>

#include "base/units.h"
#include "render/path/path_tracer.h"

namespace gischt {

bool PathTracer::has_bridges(const Medium& medium) const {
    return scene_.params.bridge && !scene_.suns.empty() && medium.phase_lobes().memory > 0;
}

// From a scattering in a medium: as many of the longest bridges as it promises light, counted along
// the run so that they are spread evenly, and from the first of a run one of the shorter ones,
// drawn by its share in the light per root of its flights.
void PathTracer::set_out_bridges(const Scatterer& at, Leg& leg, RandomStream random) {
    const int memory = at.medium->phase_lobes().memory, left = depth_ - leg.events;
    const auto suns = static_cast<float>(scene_.suns.size());
    const auto pick = static_cast<std::size_t>(random.next() * suns);
    const SunSource& sun = scene_.suns[std::min(pick, scene_.suns.size() - 1)];
    if (leg.run == 1) leg.credit = random.next();
    if (left >= memory) {
        // The optimum is flat: cost changes by 10 % when these are halved or doubled.
        constexpr float least = 0.03f, most = 4, density = 0.7f, fading = 0.7f;
        const Chain chain = chain_of(at, sun, memory, random);
        const float promise = density * static_cast<float>(4 * pi) * chain.value *
                              std::exp(-fading * forward_depth(sun, at.point, tracker_));
        const float number = std::clamp(promise, least, most);
        for (leg.credit += number; leg.credit >= 1; leg.credit -= 1) {
            bridge(at, leg, sun, chain, suns / number, random);
        }
    }
    const int longest = std::min(memory - 1, left);
    if (leg.run > 1 || longest < 1) return;
    std::array<float, PhaseLobes::longest> share{};
    const float cosine = dot(at.forward, Vec3f(sun.direction));
    const float g = at.medium->phase_lobes().lobes[0].g;
    float total = 0, power = g;
    for (int k = 1; k <= longest; ++k) {
        power *= g;
        const float value = HenyeyGreensteinPhase{power}.value(cosine);
        total += share[static_cast<std::size_t>(k)] = value / std::sqrt(static_cast<float>(k));
    }
    float u = random.next() * total;
    int turns = 1;
    while (turns < longest && u >= share[static_cast<std::size_t>(turns)]) {
        u -= share[static_cast<std::size_t>(turns++)];
    }
    const Chain chain = chain_of(at, sun, turns, random);
    bridge(at, leg, sun, chain, suns * total / share[static_cast<std::size_t>(turns)], random);
}

// The lobes of so many turns and the last one, to the sun.
PathTracer::Chain PathTracer::chain_of(const Scatterer& at, const SunSource& sun, int turns,
                                       RandomStream& random) {
    Chain chain;
    chain.turns = static_cast<std::size_t>(turns);
    chain.sun = sun.light->sample(at.point, random.two());
    chain.rest[chain.turns + 1] = 1;
    for (std::size_t i = chain.turns + 1; i-- > 0;) {
        chain.lobe[i] = at.medium->phase_lobes().pick([&] { return random.next(); });
        chain.rest[i] = chain.rest[i + 1] * chain.lobe[i].g;
    }
    const float cosine = dot(at.forward, Vec3f(chain.sun.direction));
    chain.value = HenyeyGreensteinPhase{chain.rest[0]}.value(cosine);
    return chain;
}

void PathTracer::bridge(const Scatterer& at, Leg leg, const SunSource& sun, const Chain& chain,
                        float factor, RandomStream& random) {
    if (max_component(chain.sun.weight) <= 0) return;
    factor *= chain.value;
    Scatterer end = at;
    Vec3d forward(at.forward);
    const std::optional<InteriorStack> inside = inside_;
    const bool had_glow = std::exchange(tracker_.is_emissive, false);
    bool arrives = true;
    for (std::size_t i = 0; i < chain.turns && arrives; ++i) {
        const Vec2f u = random.two();
        const Vec3d next = sample_between(forward, chain.lobe[i].g, chain.sun.direction,
                                          chain.rest[i + 1], {u.x, u.y, random.next()});
        factor *= kernel_factor(chain.lobe[i], static_cast<float>(dot(forward, next)));
        leg.ray = {end.point, next};
        arrives = take_flight(leg, *at.medium, random);
        end.point = leg.ray.origin;
        forward = next;
    }
    if (arrives) {
        end.forward = Vec3f(forward);
        factor *=
            kernel_factor(chain.lobe[chain.turns], dot(end.forward, Vec3f(chain.sun.direction)));
        deposit(
            leg.weight.value() * factor * chain.sun.weight * sunlight(sun, end, chain.sun, random),
            leg.events, sun.index);
    }
    tracker_.is_emissive = had_glow;
    if (inside) {
        inside_ = inside;
        take_media();
    }
}

// To the next collision, whose point is then the origin of the ray. False where it is none of this
// medium.
bool PathTracer::take_flight(Leg& leg, const Medium& medium, RandomStream& random) {
    Collision collision;
    std::optional<SurfaceHit> hit;
    if (fly(leg, random, collision, hit) != End::Collision) return false;
    if (tracker_.media[collision.medium] != &medium) return false;
    const CrossSections& cross = medium.cross_sections();
    leg.weight.weight = leg.weight.weight * collision.color * cross.scattering /
                        max(cross.extinction(), Vec3f(1e-30f));
    ++leg.events;
    leg.ray.origin = leg.ray.at(collision.t);
    return true;
}

}  // namespace gischt
