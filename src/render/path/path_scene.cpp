// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "grid/frame.h"
#include "image/color.h"
#include "optics/environment.h"
#include "optics/local_lights.h"
#include "optics/material.h"
#include "optics/medium.h"
#include "render/path/media_walk.h"

namespace gischt {
namespace {

bool has_equal_channels(const Vec3f& v) {
    return v.x == v.y && v.y == v.z;
}

// Voxels between the nodes of a grid such that it has at most `most` nodes.
double spacing_of(const Medium& medium, std::int64_t most) {
    const Vec3d size = medium.lattice().box.size();
    const double nodes = (size.x + 1) * (size.y + 1) * (size.z + 1);
    return std::max(1.0, std::cbrt(nodes / static_cast<double>(most)));
}

}  // namespace

PathScene::PathScene(const View& the_view, const PathParams& the_params, Job& job, bool meets_all)
    : view(the_view), params(the_params) {
    if (view.media.size() > most_media) {
        throw Error(ErrorKind::Usage, "path", fmt::format("{} media", view.media.size()),
                    fmt::format("it takes at most {}", most_media));
    }
    for (const auto& m : view.media) {
        if (m->majorant() == 0 && m->emission_majorant() == 0) continue;
        is_grey = is_grey && has_equal_channels(m->cross_sections().extinction());
        is_emissive = is_emissive || m->is_emissive();
        if (!view.surfaces.is_interior(m.get())) media.push_back(m.get());
    }
    take_motion();
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const SurfaceInfo& info = view.surfaces.info(i);
        has_interiors = has_interiors || info.has_interior;
        if (!info.medium) continue;
        is_grey = is_grey && has_equal_channels(info.medium->cross_sections().extinction());
        is_emissive = is_emissive || info.medium->is_emissive();
    }
    surface_light.resize(static_cast<std::size_t>(view.surfaces.size()));
    for (const auto& light : view.surfaces.lights()) {
        surface_light[static_cast<std::size_t>(light->surface())] = light.get();
        local.push_back({light.get(), -1});
    }
    // What fires send to a surface varies more from path to path than anything else there.
    surface_splits = params.surface_splits > 0 ? params.surface_splits : is_emissive ? 4 : 1;
    if (is_emissive && !has_interiors) glow = EmissionSampler(view.media);
    sort_lights(job);
    sky_chance = chance_of_skies();
    for (const Drawn& d : local) {
        if (d.light->place()) placed.push_back(d.light);
    }
    if (!meets_all) refuse_what_none_can_meet();
}

// A light without size behind glass: no shadow ray passes the glass, and no random walk meets it.
void PathScene::refuse_what_none_can_meet() const {
    const auto is_tiny = [](const LightPtr& light) {
        return light->is_delta() || dynamic_cast<const SunLight*>(light.get());
    };
    const auto tiny = std::find_if(view.lights.begin(), view.lights.end(), is_tiny);
    if (tiny == view.lights.end()) return;
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const SurfaceInfo& info = view.surfaces.info(i);
        if (info.material != MaterialKind::Dielectric || !info.medium) continue;
        throw Error(
            ErrorKind::Usage, "path",
            fmt::format("light '{}' has no size, and would not be seen in the medium behind "
                        "the glass of '{}'",
                        (*tiny)->name, info.name),
            "take a rect, disc, sphere, constant or environment light, method 'photon', or 'march' "
            "without the glass");
    }
}

void PathScene::sort_lights(Job& job) {
    const PhaseTimer timer(job, "light grids");
    for (std::size_t i = 0; i < view.lights.size(); ++i) {
        const Light* light = view.lights[i].get();
        const int index = static_cast<int>(i);
        if (!light->is_infinite()) {
            local.push_back({light, index});
        } else if (const auto* sun = dynamic_cast<const SunLight*>(light)) {
            suns.push_back({sun, index, sun->direction(), {}});
            if (params.shadow == TransmittanceEstimator::Cached && !has_interiors) {
                make_grids(suns.back(), job);
            }
        } else if (dynamic_cast<const ConstantLight*>(light)) {
            even.push_back({light, index});
        } else {
            broad.push_back({light, index});
        }
    }
}

// In proportion to how far the brightest spot of them stands out.
float PathScene::chance_of_skies() const {
    constexpr float sure = 1000;  // times the mean
    float peak = 0;
    for (const Drawn& d : broad) {
        const auto* sky = dynamic_cast<const EnvironmentLight*>(d.light);
        if (!sky) return static_cast<float>(params.sky_chance);
        float brightest = 0;
        for (int y = 0; y < sky->map().height(); ++y) {
            for (int x = 0; x < sky->map().width(); ++x)
                brightest = std::max(brightest, luminance(sky->map().texel(x, y)));
        }
        peak = std::max(peak, brightest / std::max(luminance(sky->map().mean()), 1e-30f));
    }
    return std::min(static_cast<float>(params.sky_chance), peak / sure);
}

void PathScene::take_motion() {
    moving_.resize(std::max<std::size_t>(1, view.moving_media.size()));
    for (std::size_t part = 0; part < moving_.size(); ++part) {
        for (const Medium* m : media) {
            moving_[part].push_back(medium_in(static_cast<int>(part), m));
        }
    }
    for (std::size_t i = 0; i < std::min(view.frames.size(), view.media.size()); ++i) {
        const Field* velocity = view.frames[i]->find("velocity");
        if (!velocity || !velocity->is_vector()) continue;
        velocity_[view.media[i].get()] = velocity;
        for (const auto& media_then : view.moving_media) velocity_[media_then[i].get()] = velocity;
    }
}

const Medium* PathScene::medium_in(int part, const Medium* middle) const {
    if (view.moving_media.empty()) return middle;
    const auto found = std::find_if(view.media.begin(), view.media.end(),
                                    [=](const auto& m) { return m.get() == middle; });
    if (found == view.media.end()) return middle;
    const auto i = static_cast<std::size_t>(found - view.media.begin());
    return view.moving_media[static_cast<std::size_t>(part)][i].get();
}

// A grid for each medium in each part of the shutter's time; together they have as many nodes as
// that of one at rest may have.
void PathScene::make_grids(SunSource& sun, Job& job) const {
    for (std::size_t part = 0; part < moving_.size(); ++part) {
        for (std::size_t i = 0; i < media.size(); ++i) {
            const Medium* m = moving_[part][i];
            if (part > 0 && m == moving_[part - 1][i]) {
                sun.depth.push_back(sun.depth[sun.depth.size() - media.size()]);
            } else if (m->cell_size() > 0 && m->strength() > 0) {
                const bool is_moving = m != moving_.back()[i] || part > 0;
                const std::int64_t nodes =
                    is_moving ? params.cache_nodes / parts() : params.cache_nodes;
                sun.depth.push_back(std::make_shared<const SunDepth>(
                    *m, sun.direction, spacing_of(*m, std::max<std::int64_t>(nodes, 1)), job));
            } else {
                sun.depth.push_back(nullptr);  // what has no voxels is integrated at once
            }
        }
    }
}

float PathScene::local_share(const Light& light, const Vec3d& point) const {
    float total = 0;
    for (const Drawn& d : local) total += luminance(d.light->mean_radiance(point));
    return total > 0 ? luminance(light.mean_radiance(point)) / total : 0;
}

}  // namespace gischt
