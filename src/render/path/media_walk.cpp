// SPDX-License-Identifier: Apache-2.0
#include "render/path/media_walk.h"

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace gischt {

static constexpr double never = std::numeric_limits<double>::infinity();

MediaWalk::MediaWalk(std::span<const Medium* const> media, const Ray& ray, BrickGrain grain)
    : media_(media), t_(ray.t_min), t_end_(ray.t_max) {
    GISCHT_ASSERT(media.size() <= most_media);
    if (media.size() == 1) {
        only_.emplace(*media[0], ray, grain);
        one_.medium = media[0];
        return;
    }
    walkers_.reserve(media.size());
    active_.resize(media.size());
    for (const Medium* m : media) {
        walkers_.push_back({m->segments(ray, grain), {}});
        advance(walkers_.back());
    }
}

void MediaWalk::advance(Walker& w) {
    if (!w.walk.next(w.segment)) w.segment.t0 = w.segment.t1 = never;
}

// The common case: the medium's segments are the runs.
bool MediaWalk::next_of_one(MediaRun& run) {
    if (!only_->next(one_.segment)) return false;
    const MediumSegment& s = one_.segment;
    run = {s.t0, s.t1, s.min, s.mean, s.max, s.emission_max, {&one_, 1}};
    return true;
}

bool MediaWalk::next(MediaRun& run) {
    if (only_) return next_of_one(run);
    for (;;) {
        // The run begins where the first medium does, and ends where the set of media changes.
        double begin = never;
        for (Walker& w : walkers_) {
            while (w.segment.t1 <= t_ && w.segment.t0 < never) advance(w);
            begin = std::min(begin, std::max(t_, w.segment.t0));
        }
        if (!(begin < t_end_)) return false;
        double end = t_end_;
        std::size_t count = 0;
        run = {};
        for (std::size_t i = 0; i < walkers_.size(); ++i) {
            const MediumSegment& s = walkers_[i].segment;
            if (s.t0 > begin) {
                end = std::min(end, s.t0);
                continue;
            }
            end = std::min(end, s.t1);
            active_[count++] = {media_[i], i, s};
            run.min += s.min;
            run.mean += s.mean;
            run.max += s.max;
            run.emission_max += s.emission_max;
        }
        t_ = end;
        if (!(begin < end)) continue;
        run.t0 = begin;
        run.t1 = end;
        run.active = {active_.data(), count};
        return true;
    }
}

}  // namespace gischt
