// SPDX-License-Identifier: Apache-2.0
#include "render/path/media_walk.h"

#include <algorithm>
#include <limits>

namespace gischt {

static constexpr double never = std::numeric_limits<double>::infinity();

MediaWalk::MediaWalk(std::span<const Medium* const> media, const Ray& ray, BrickGrain grain)
    : media_(media), t_(ray.t_min), t_end_(ray.t_max) {
    GISCHT_ASSERT(media.size() <= most_media);
    for (std::size_t i = 0; i < media.size(); ++i) {
        walk_[i].emplace(media[i]->segments(ray, grain));
        if (media.size() > 1) advance(i);
    }
}

void MediaWalk::advance(std::size_t i) {
    if (!walk_[i]->next(segment_[i])) segment_[i].t0 = segment_[i].t1 = never;
}

// One medium, the common case: its segments are the runs.
bool MediaWalk::next_of_one(MediaRun& run) {
    ActiveMedium& one = active_[0];
    if (!walk_[0]->next(one.segment)) return false;
    one.medium = media_[0];
    run = {one.segment.t0,   one.segment.t1,  one.segment.min,
           one.segment.mean, one.segment.max, {active_.data(), 1}};
    return true;
}

bool MediaWalk::next(MediaRun& run) {
    const std::size_t n = media_.size();
    if (n == 0) return false;
    if (n == 1) return next_of_one(run);
    for (;;) {
        // The run ends where the first segment ends or the next one begins.
        double begin = never;
        for (std::size_t i = 0; i < n; ++i) {
            if (segment_[i].t1 <= t_) advance(i);
            begin = std::min(begin, std::max(t_, segment_[i].t0));
        }
        if (!(begin < t_end_) || begin == never) return false;
        double end = t_end_;
        std::size_t count = 0;
        run.min = run.mean = run.max = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const MediumSegment& s = segment_[i];
            if (s.t0 > begin) {
                end = std::min(end, s.t0);
                continue;
            }
            end = std::min(end, s.t1);
            active_[count++] = {media_[i], i, s};
            run.min += s.min;
            run.mean += s.mean;
            run.max += s.max;
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
