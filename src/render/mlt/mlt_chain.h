// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "render/bdpt/bdpt_tracer.h"
#include "render/mlt/mlt_params.h"
#include "render/mlt/primary_numbers.h"

namespace gischt {

// What a path brings that one of the strategies makes of primary numbers.
struct MltSample {
    std::size_t s = 0, t = 0;  // vertices from the light and from the camera
    FilmSplat splat;           // the path over the density of its numbers
    double brightness = 0;     // luminance of that
};

// Paths of multiplexed primary-sample-space Metropolis light transport (after Hachisuka, Kaplanyan,
// Dachsbacher 2014): a state is a strategy (s, t) of bidirectional path tracing and the numbers of
// both subpaths; its target is the luminance of that one contribution, weighed by multiple
// importance sampling, so that strategies are taken as often as they are worth. The same numbers
// make the contributions of all strategies, which serve to start anew.
class MltPaths {
  public:
    // `margin`: pixels around the picture in which splats still count.
    MltPaths(const BdptScene& scene, const MltParams& params, int depth, double margin);

    // One strategy; brightness 0 where it makes no path.
    MltSample one(PrimaryNumbers& numbers, std::size_t s, std::size_t t);
    // All strategies that make one, and the sum of their brightness.
    double all(PrimaryNumbers& numbers, std::vector<MltSample>& samples);

    // The track of the place on the film.
    static constexpr std::size_t film_track = 1;

    std::int64_t rays() const { return tracer_.rays(); }
    std::int64_t lookups() const { return tracer_.lookups(); }

  private:
    // Where on the film, through which point of the lens, in which channel.
    struct Aim {
        double x = 0, y = 0;
        Vec2f lens;
        int hero = 0;
    };
    Aim aim(PrimaryNumbers& numbers) const;
    void trace(PrimaryNumbers& numbers, const Aim& aim, std::size_t s, std::size_t t);
    MltSample contribution(PrimaryNumbers& numbers, const Aim& aim, std::size_t s, std::size_t t);
    bool is_wanted(std::size_t s, std::size_t t) const;

    const BdptScene& scene_;
    double margin_;
    BdptTracer tracer_;
    std::size_t least_vertices_ = 3;
};

// One round: as many mutations as `mutations`, by independent chains that start at paths drawn in
// proportion to their brightness from a pool, whose mean brightness scales all. So its expectation
// is the picture whatever the number of mutations: there is no bias of the start (Veach 1997,
// 11.3.1). A pure function of the key. Each chain gets the paths of one worker.
struct MltRound {
    std::int64_t mutations = 1, pool = 1;
    int chains = 1;
};
using MltPathsMaker = std::function<std::unique_ptr<MltPaths>()>;
std::vector<std::vector<FilmSplat>> paint_round(const MltRound& round, const MltParams& params,
                                                std::uint64_t key, const MltPathsMaker& make,
                                                Job& job);

}  // namespace gischt
