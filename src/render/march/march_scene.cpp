// SPDX-License-Identifier: Apache-2.0
#include "render/march/march_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/local_lights.h"
#include "optics/material.h"

namespace gischt {
namespace {

// A disc wider than this casts shadows too soft for one direction: 6.5 degrees.
constexpr float least_narrow_pdf = 100;  // 1/sr

std::optional<NarrowLight> as_narrow(const Light& light) {
    NarrowLight narrow{&light, light.is_infinite(), {}, {}};
    if (!light.is_infinite()) return light.is_delta() ? std::optional(narrow) : std::nullopt;
    const LightSample sample = light.sample({}, {0, 0});
    const bool is_small_disc =
        dynamic_cast<const SunLight*>(&light) && sample.pdf > least_narrow_pdf;
    if (!light.is_delta() && !is_small_disc) return std::nullopt;
    narrow.direction = sample.direction;
    narrow.weight = sample.weight;
    return narrow;
}

// Surfaces that light passes, or is mirrored by, would need rays of their own at each hit.
void refuse_unknown_surfaces(const SurfaceSet& surfaces) {
    for (int i = 0; i < surfaces.size(); ++i) {
        const SurfaceInfo& info = surfaces.info(i);
        if (info.is_lamp) {
            throw Error(ErrorKind::Usage, "march", fmt::format("light '{}' has a size", info.name),
                        "take method 'path'");
        }
        const bool is_special = info.holdout || info.shadow_catcher;
        if (info.material == MaterialKind::Lambert && !is_special) continue;
        throw Error(ErrorKind::Usage, "march",
                    fmt::format("solid '{}' {}", info.name,
                                is_special ? "is a holdout or shadow catcher"
                                           : "scatters light in another way than Lambert's"),
                    "take method 'path'");
    }
}

}  // namespace

double grid_spacing(const Medium& medium, double least, std::int64_t most) {
    const Vec3d n = medium.lattice().box.size();
    double spacing = least;
    while (n.x * n.y * n.z / (spacing * spacing * spacing) > static_cast<double>(most)) {
        spacing = spacing < 1 ? 2 * spacing : spacing + 1;
    }
    return spacing;
}

MarchScene::MarchScene(const View& the_view, const MarchParams& the_params, Job& job, int the_depth)
    : view(the_view), params(the_params), depth(the_depth) {
    refuse_unknown_surfaces(view.surfaces);
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
        if (!medium->has_lattice()) {
            throw Error(ErrorKind::Usage, "march",
                        "a medium has no end, or is as large as a planet",
                        "give the fog a box, or take method 'path'");
        }
        MarchMedium m;
        m.medium = medium.get();
        m.extinction = medium->cross_sections().extinction();
        m.scattering = medium->cross_sections().scattering;
        m.octaves = octaves_of(*medium);
        if (depth > 1 && m.octaves.size() > 1) {
            m.octaves.resize(1);
            job.info("march: multiple_scattering.octaves are left out, depth takes their place");
        }
        m.octaves_halve = medium->multiple_scattering().attenuation == 0.5;
        m.feature = medium->cell_size() > 0 ? medium->cell_size()
                                            : length(medium->lattice().to_world.column[0]);
        is_grey = is_grey && m.extinction.x == m.extinction.y && m.extinction.x == m.extinction.z;
        media.push_back(std::move(m));
    }
    const PhaseTimer timer(job, "light");
    if (!view.surfaces.is_empty()) {
        for (const Light* light : broad) {
            aimed_sky.emplace_back(*light);
            open_sky.emplace_back(*light);
        }
    }
    if (!params.light_cache) return;
    for (MarchMedium& m : media) make_depth_grids(m, job);
    for (std::size_t i = 0; i < media.size() && !broad.empty(); ++i) {
        if (max_component(media[i].scattering) == 0) continue;
        media[i].sky = std::make_unique<const SkyGrid>(*this, i, job);
    }
}

// Towards each narrow light; homogeneous media need none, their depth is a product.
void MarchScene::make_depth_grids(MarchMedium& m, Job& job) const {
    m.sun_depth.resize(narrow.size());
    m.point_depth.resize(narrow.size());
    if (m.medium->cell_size() == 0 || m.medium->strength() == 0) return;
    // Where a voxel is optically thick, light falls off within it.
    const double thickness = m.medium->cell_size() * static_cast<double>(m.medium->majorant());
    const double least = params.shadow_spacing > 0 ? params.shadow_spacing
                         : thickness > 0.5         ? 0.5
                                                   : 1;
    const double spacing = grid_spacing(*m.medium, least, params.cache_nodes);
    for (std::size_t l = 0; l < narrow.size(); ++l) {
        if (narrow[l].is_infinite) {
            m.sun_depth[l] =
                std::make_unique<const SunDepth>(*m.medium, narrow[l].direction, spacing, job);
        } else if (max_component(m.scattering) > 0) {
            const Box3d box = m.medium->bounds();
            const LightSample s = narrow[l].light->sample(box.lo, {0, 0});
            m.point_depth[l] =
                std::make_unique<const PointDepth>(*m.medium, box.lo + s.distance * s.direction,
                                                   std::max(spacing, 1.0), shadow_steps(), job);
        }
    }
}

Vec3f MarchScene::depth_to(std::size_t light, const Vec3d& point, const LightSample& sample,
                           std::size_t inside) const {
    Vec3f sum;
    for (std::size_t i = 0; i < media.size(); ++i) {
        const MarchMedium& m = media[i];
        const SunDepth* sun = m.sun_depth.empty() ? nullptr : m.sun_depth[light].get();
        // Beside the light its depth has a cusp that no grid holds, and the way is short.
        const bool is_close = sample.distance < 4 * m.feature;
        const PointDepth* near =
            m.point_depth.empty() || i != inside || is_close ? nullptr : m.point_depth[light].get();
        sum += m.extinction *
               (sun    ? (*sun)(point)
                : near ? (*near)(point)
                       : density_integral(*m.medium, {point, sample.direction, 0, sample.distance},
                                          shadow_steps()));
    }
    return sum;
}

}  // namespace gischt
