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

// What a state of a chain brings.
struct MltSample {
    FilmSplat splat;        // of the path over the density of its primary numbers
    double brightness = 0;  // luminance of that
};

// Paths by multiplexed primary-sample-space Metropolis light transport (Hachisuka, Kaplanyan,
// Dachsbacher 2014): a state holds the number of edges k of a path, which of its k + 1 strategies
// of bidirectional path tracing makes it, and the numbers for both subpaths. Its target is the
// luminance of that one contribution, weighed by multiple importance sampling, so that strategies
// are taken as often as they are worth.
class MltPaths {
  public:
    // `margin`: pixels around the picture in which splats still count.
    MltPaths(const BdptScene& scene, const MltParams& params, int depth, double margin);

    MltSample operator()(PrimaryNumbers& numbers);

    std::int64_t rays() const { return tracer_.rays(); }
    std::int64_t lookups() const { return tracer_.lookups(); }

  private:
    const BdptScene& scene_;
    const MltParams& params_;
    double margin_;
    BdptTracer tracer_;
    std::size_t least_ = 2;
    std::vector<double> cumulative_;  // over the numbers of edges from least_ on
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
