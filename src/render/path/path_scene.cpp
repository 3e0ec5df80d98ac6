// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_scene.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "optics/environment.h"
#include "optics/local_lights.h"
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

PathScene::PathScene(const View& the_view, const PathParams& the_params, Job& job)
    : view(the_view), params(the_params) {
    if (view.media.size() > most_media) {
        throw Error(ErrorKind::Usage, "path", fmt::format("{} media", view.media.size()),
                    fmt::format("it takes at most {}", most_media));
    }
    for (const auto& m : view.media) {
        if (m->majorant() == 0 && !m->is_emissive()) continue;
        media.push_back(m.get());
        is_grey = is_grey && has_equal_channels(m->cross_sections().extinction());
        is_emissive = is_emissive || m->is_emissive();
    }
    const PhaseTimer timer(job, "light grids");
    for (const LightPtr& light : view.lights) {
        if (!light->is_infinite()) {
            local.push_back(light.get());
        } else if (const auto* sun = dynamic_cast<const SunLight*>(light.get())) {
            SunSource& source = suns.emplace_back();
            source.light = sun;
            source.direction = sun->direction();
            if (params.shadow != TransmittanceEstimator::Cached) continue;
            for (const Medium* m : media) {
                // What has no voxels is integrated at once.
                source.depth.push_back(
                    m->cell_size() > 0 && m->strength() > 0
                        ? std::make_unique<SunDepth>(*m, source.direction,
                                                     spacing_of(*m, params.cache_nodes), job)
                        : nullptr);
            }
        } else if (dynamic_cast<const ConstantLight*>(light.get())) {
            even.push_back(light.get());
        } else {
            broad.push_back(light.get());
        }
    }
}

Vec3f PathScene::even_radiance() const {
    Vec3f sum;
    for (const Light* light : even) sum += light->radiance({0, 0, 1});
    return sum;
}

}  // namespace gischt
