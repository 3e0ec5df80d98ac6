// SPDX-License-Identifier: Apache-2.0
#include "render/march/march_scene.h"

#include <algorithm>
#include <cmath>

#include "optics/local_lights.h"

namespace gischt {
namespace {

// A disc wider than this casts shadows too soft for one direction: 6.5 degrees.
constexpr float least_narrow_pdf = 100;  // 1/sr

std::optional<NarrowLight> as_narrow(const Light& light) {
    NarrowLight narrow{&light, light.is_infinite(), {}, {}};
    if (!light.is_infinite()) return narrow;
    const LightSample sample = light.sample({}, {0, 0});
    const bool is_small_disc =
        dynamic_cast<const SunLight*>(&light) && sample.pdf > least_narrow_pdf;
    if (!light.is_delta() && !is_small_disc) return std::nullopt;
    narrow.direction = sample.direction;
    narrow.weight = sample.weight;
    return narrow;
}

}  // namespace

int grid_spacing(const Medium& medium, int least, std::int64_t most) {
    const Vec3d n = medium.lattice().box.size();
    int spacing = least;
    while (n.x * n.y * n.z / std::pow(spacing, 3) > static_cast<double>(most)) ++spacing;
    return spacing;
}

MarchScene::MarchScene(const View& the_view, const MarchParams& the_params, Job& job)
    : view(the_view), params(the_params) {
    for (const LightPtr& light : view.lights) {
        if (const auto one = as_narrow(*light)) {
            narrow.push_back(*one);
        } else if (light->is_infinite()) {
            broad.push_back(light.get());
        } else {
            throw Error(ErrorKind::Usage, "march",
                        "light '" + light->name + "' is neither a point nor at infinity",
                        "take method 'path'");
        }
    }
    is_grey = true;
    for (const auto& medium : view.media) {
        MarchMedium m;
        m.medium = medium.get();
        m.extinction = medium->cross_sections().extinction();
        m.scattering = medium->cross_sections().scattering;
        m.octaves = octaves_of(*medium);
        m.octaves_halve = medium->multiple_scattering().attenuation == 0.5;
        m.feature = medium->cell_size() > 0 ? medium->cell_size()
                                            : length(medium->lattice().to_world.column[0]);
        is_grey = is_grey && m.extinction.x == m.extinction.y && m.extinction.x == m.extinction.z;
        media.push_back(std::move(m));
    }
    if (!params.light_cache) return;
    const PhaseTimer timer(job, "light");
    for (MarchMedium& m : media) {
        m.sun_depth.resize(narrow.size());
        if (m.medium->cell_size() == 0 || m.medium->strength() == 0) continue;
        for (std::size_t l = 0; l < narrow.size(); ++l) {
            if (!narrow[l].is_infinite) continue;
            const int spacing = grid_spacing(*m.medium, 1, params.cache_nodes);
            m.sun_depth[l] =
                std::make_unique<const SunDepth>(*m.medium, narrow[l].direction, spacing, job);
        }
    }
    for (std::size_t i = 0; i < media.size() && !broad.empty(); ++i) {
        if (max_component(media[i].scattering) == 0) continue;
        media[i].sky = std::make_unique<const SkyGrid>(*this, i, job);
    }
}

Vec3f MarchScene::depth_to(std::size_t narrow_light, const Vec3d& point, const Vec3d& direction,
                           double distance, bool cached) const {
    Vec3f depth;
    for (const MarchMedium& m : media) {
        const SunDepth* grid =
            cached && !m.sun_depth.empty() ? m.sun_depth[narrow_light].get() : nullptr;
        const float integral =
            grid ? (*grid)(point)
                 : density_integral(*m.medium, {point, direction, 0, distance}, shadow_steps());
        depth += integral * m.extinction;
    }
    return depth;
}

}  // namespace gischt
