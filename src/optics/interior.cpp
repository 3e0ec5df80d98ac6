// SPDX-License-Identifier: Apache-2.0
#include "optics/interior.h"

#include <algorithm>

#include "base/error.h"
#include "optics/material.h"

namespace gischt {

InteriorStack::InteriorStack(const SurfaceSet& surfaces, const Vec3d& point, float moment)
    : surfaces_(&surfaces) {
    for (const int surface : surfaces.interiors_at(point, moment)) {
        SurfaceHit hit;
        hit.surface = surface;
        cross(hit);
    }
}

int InteriorStack::top(int changed, int step, bool refracting) const {
    int best = -1;
    const auto offer = [&](int surface) {
        const SurfaceInfo& info = surfaces_->info(surface);
        if (refracting && info.material == MaterialKind::None) return;
        if (best < 0 || info.priority >= surfaces_->info(best).priority) best = surface;
    };
    bool is_known = false;
    for (int i = 0; i < count_; ++i) {
        const Entry& e = entries_[static_cast<std::size_t>(i)];
        is_known = is_known || e.surface == changed;
        if (e.times + (e.surface == changed ? step : 0) > 0) offer(e.surface);
    }
    if (!is_known && step > 0) offer(changed);
    return best;
}

double InteriorStack::ior_of(int surface) const {
    return surface < 0 ? 1 : surfaces_->info(surface).ior;
}

const Medium* InteriorStack::medium() const {
    const int s = surface();
    return s < 0 ? nullptr : surfaces_->info(s).medium.get();
}

InteriorStack::Crossing InteriorStack::at(const SurfaceHit& hit) const {
    const SurfaceInfo& info = surfaces_->info(hit.surface);
    if (info.material == MaterialKind::None) return {true, 1};
    if (!info.has_interior) return {};
    int near = top(-1, 0, true);
    const int far = top(hit.surface, hit.front ? 1 : -1, true);
    // What is left without having been entered, an open mesh, was around all the same.
    const auto end = entries_.begin() + count_;
    const bool was_entered = std::any_of(entries_.begin(), end,
                                         [&](const Entry& e) { return e.surface == hit.surface; });
    if (!hit.front && !was_entered &&
        (near < 0 || info.priority >= surfaces_->info(near).priority)) {
        near = hit.surface;
    }
    return {near == far, ior_of(far) / ior_of(near)};
}

void InteriorStack::cross(const SurfaceHit& hit) {
    if (!surfaces_->info(hit.surface).has_interior) return;
    for (int i = 0; i < count_; ++i) {
        Entry& e = entries_[static_cast<std::size_t>(i)];
        if (e.surface != hit.surface) continue;
        e.times += hit.front ? 1 : -1;
        if (e.times > 0) return;
        std::copy(entries_.begin() + i + 1, entries_.begin() + count_, entries_.begin() + i);
        --count_;
        return;
    }
    if (!hit.front) return;
    if (count_ == capacity) {
        throw Error(ErrorKind::Usage, "solid", "more than 16 interiors overlap at one point");
    }
    entries_[static_cast<std::size_t>(count_++)] = {hit.surface, 1};
}

}  // namespace gischt
