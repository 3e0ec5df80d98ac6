// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "optics/material.h"
#include "optics/medium.h"

namespace gischt {
namespace {

// Where a ground without end lies below everything, so many diagonals of the rest on each side get
// photons: what lies farther away sends back less than a hundredth of its light.
constexpr double ground_diagonals = 1;

bool is_finite(const Box3d& box) {
    return !box.is_empty() && max_component(abs(box.lo)) < 1e30 &&
           max_component(abs(box.hi)) < 1e30;
}

[[noreturn]] void refuse(const std::string& what, const std::string& hint) {
    throw Error(ErrorKind::Usage, "photon", what, hint);
}

}  // namespace

PhotonScene::PhotonScene(const View& the_view, const PhotonParams& the_params,
                         const PathParams& path_params, int the_depth, Job& job)
    : view(the_view),
      params(the_params),
      depth(the_depth),
      path(the_view, path_params, job, true),
      reach(Box3d::empty()) {
    refuse_what_it_cannot();
    for (const auto& m : view.media) media.push_back(m.get());
    bool turns_light = false;
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const SurfaceInfo& info = view.surfaces.info(i);
        turns_light = turns_light || (info.material != MaterialKind::Lambert &&
                                      info.material != MaterialKind::None);
        if (info.medium && place_of(info.medium.get()) < 0) media.push_back(info.medium.get());
    }
    find_reach();
    has_photons = depth > 1 || (depth == 1 && turns_light);
    if (!has_photons || !is_finite(reach)) {
        has_photons = false;
        return;
    }
    origin = 0.5 * (reach.lo + reach.hi);
    everywhere.emplace(view, reach, std::nullopt, job);
    has_photons = everywhere->power() > 0;
    if (has_photons) find_target(job);
}

int PhotonScene::place_of(const Medium* medium) const {
    const auto found = std::find(media.begin(), media.end(), medium);
    return found == media.end() ? -1 : static_cast<int>(found - media.begin());
}

void PhotonScene::refuse_what_it_cannot() const {
    if (!view.moving_media.empty()) {
        refuse("media move while the film is exposed",
               "set film.shutter or fluid.blur_moments so that they stand still, or take 'path'");
    }
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const SurfaceInfo& info = view.surfaces.info(i);
        if (info.is_moving) {
            refuse(fmt::format("'{}' moves while the film is exposed", info.name),
                   "set film.shutter = 0, or take 'path'");
        }
        if (max_component(info.emission) > 0 && view.surfaces.light_of(i) < 0) {
            refuse(fmt::format("'{}' glows without end", info.name),
                   "take a box or a rect in its place, or method 'path'");
        }
    }
    for (const Medium* m : path.media) {
        if (!m->is_bounded()) {
            refuse("a medium has no end, so that photons cannot fill it",
                   "put it into a box, or take 'path' or 'march'");
        }
    }
}

void PhotonScene::find_reach() {
    for (const Medium* m : path.media) {
        if (is_finite(m->bounds())) reach.extend(m->bounds());
    }
    bool is_endless = false;
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const Box3d box = view.surfaces.bounds_of(i);
        if (max_component(abs(box.lo)) < 1e30 && max_component(abs(box.hi)) < 1e30) {
            reach.extend(box);
        } else {
            is_endless = true;
        }
    }
    if (!(reach.lo.x <= reach.hi.x)) return;
    const double diagonal = length(reach.size());
    const double margin = (is_endless ? ground_diagonals : 1e-6) * diagonal;
    reach = {reach.lo - Vec3d(margin), reach.hi + Vec3d(margin)};
}

// Where media, glass and metal fill a small part of the reach.
void PhotonScene::find_target(Job& job) {
    Box3d box = Box3d::empty();
    for (const Medium* m : path.media) {
        if (is_finite(m->bounds())) box.extend(m->bounds());
    }
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const MaterialKind kind = view.surfaces.info(i).material;
        if (kind == MaterialKind::Lambert || kind == MaterialKind::Plastic) continue;
        const Box3d of_surface = view.surfaces.bounds_of(i);
        if (max_component(abs(of_surface.lo)) < 1e30) box.extend(of_surface);
    }
    const bool is_aimable =
        std::any_of(everywhere->sources().begin(), everywhere->sources().end(), [](const auto& s) {
            return s.kind == EmittedLight::Kind::Point || s.kind == EmittedLight::Kind::Infinity;
        });
    if (params.aim == 0 || !is_aimable || !is_finite(box)) return;
    const Vec3d part = box.size(), all = reach.size();
    const auto side = [](const Vec3d& e) { return e.x * e.y + e.y * e.z + e.z * e.x; };
    constexpr double nearly_all = 0.7;
    if (side(part) > nearly_all * side(all)) return;
    target.emplace(box);
    aimed.emplace(view, reach, box, job);
}

}  // namespace gischt
