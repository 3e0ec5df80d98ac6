// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/bdpt_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "optics/material.h"

namespace gischt {
namespace {

PathParams path_params_of(const BdptParams& params) {
    PathParams p;
    p.shadow = params.shadow;
    p.camera = CameraSegment::Tracking;
    p.bridge = false;
    p.roulette = params.roulette;
    return p;
}

void refuse(const View& view, std::string_view method) {
    const auto fail = [&](const std::string& what, const std::string& hint) {
        throw Error(ErrorKind::Usage, std::string(method), what, hint);
    };
    if (view.shutter > 0) {
        fail("it has no motion blur", "set film.shutter = 0, or take method 'path'");
    }
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const SurfaceInfo& info = view.surfaces.info(i);
        const char* kind = info.holdout          ? "a holdout"
                           : info.shadow_catcher ? "a shadow catcher"
                                                 : nullptr;
        if (!kind) continue;
        fail(fmt::format("'{}' is {}, which light paths do not know", info.name, kind),
             "take method 'path'");
    }
}

// Around all that ends, and around the eye where nothing does.
Box3d reach_of(const View& view) {
    Box3d box = view.surfaces.bounds();
    bool is_endless = false;
    for (const auto& m : view.media) {
        const Box3d b = m->bounds();
        if (m->is_bounded() && !b.is_empty()) {
            box.extend(b);
        } else {
            is_endless = true;
        }
    }
    for (int i = 0; i < view.surfaces.size(); ++i) {
        if (const auto& m = view.surfaces.info(i).medium; m && m->is_bounded()) {
            box.extend(m->bounds());
        }
    }
    const Vec3d eye = view.camera.position();
    for (const auto& light : view.lights) {
        if (const auto place = light->place(); place && box.is_empty()) box.extend(place->center);
    }
    if (box.is_empty()) {
        box.extend(eye);
        is_endless = true;
    }
    if (is_endless) {
        const double far = std::max(length(box.size()), 10.0);
        box.extend(eye);
        box = {box.lo - Vec3d(0.5 * far), box.hi + Vec3d(0.5 * far)};
    }
    // A ground without end is lit around what stands on it.
    const double margin = 0.01 * length(box.size()) + 1e-6;
    return {box.lo - Vec3d(margin), box.hi + Vec3d(margin)};
}

}  // namespace

BdptScene::BdptScene(const View& the_view, const BdptParams& the_params, std::string_view method,
                     Job& job)
    : params(the_params),
      path_params(path_params_of(the_params)),
      path((refuse(the_view, method), the_view), path_params, job, true),
      view(the_view),
      reach(reach_of(the_view)) {
    take_glow();
    take_sources(job);
}

void BdptScene::take_glow() {
    std::vector<std::shared_ptr<const Medium>> media;
    const auto add = [&](const std::shared_ptr<const Medium>& m) {
        if (!m || !m->is_emissive() || m->emission_majorant() == 0) return;
        if (!glow_index_.emplace(m.get(), static_cast<int>(media.size())).second) return;
        media.push_back(m);
    };
    for (const auto& m : view.media) add(m);
    for (int i = 0; i < view.surfaces.size(); ++i) add(view.surfaces.info(i).medium);
    if (media.empty()) return;
    glow = EmissionSampler(media);
    for (const auto& m : media) {
        glowing.push_back(m.get());
        const double across = length(m->bounds().size());
        glow_rate = std::max({glow_rate, static_cast<double>(m->majorant()), 1 / across});
    }
}

void BdptScene::take_sources(Job& job) {
    const PhaseTimer timer(job, "light sources");
    emission.emplace(view, reach, std::nullopt, job);
    for (std::size_t i = 0; i < emission->sources().size(); ++i) {
        const LightEmission::Source& s = emission->sources()[i];
        if (s.light) light_sources_[s.light] = static_cast<int>(i);
        if (s.medium) medium_sources_[s.medium] = static_cast<int>(i);
    }
    if (!(emission->power() > 0)) emission.reset();
}

double BdptScene::far_share(const Light& light) const {
    for (const SunSource& sun : path.suns) {
        if (sun.light == &light) return 1;
    }
    for (const auto& d : path.broad) {
        if (d.light == &light) return 1 / static_cast<double>(path.broad.size());
    }
    return 0;
}

bool BdptScene::is_in_reach(const Vec3d& point, const Vec3d& travel) const {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const Interval inside = clip(Ray{point, travel, -endless, endless}, reach);
    // Light sets out that far before the box (optics/light_emission.cpp).
    return !inside.is_empty() && inside.t0 - 1.01 * length(reach.size()) <= 0;
}

}  // namespace gischt
