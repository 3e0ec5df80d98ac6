// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/zone_grid.h"

#include <algorithm>
#include <cmath>

#include "optics/medium_bake.h"

namespace gischt {

ZoneGrid ZoneGrid::even(const Box3d& box, const Vec3i& cells, float extinction, float albedo) {
    ZoneGrid grid;
    grid.box = box;
    grid.cells = cells;
    grid.extinction.assign(volume(cells), Vec3f(extinction));
    grid.scattering.assign(volume(cells), Vec3f(albedo * extinction));
    return grid;
}

Vec3f ZoneGrid::interpolate_signed(std::span<const Vec3f> values, const Vec3d& point) const {
    const Vec3d at = (point - box.lo) / cell_size() - Vec3d(0.5);
    Vec3i first;
    Vec3f f;
    for (int a = 0; a < 3; ++a) {
        const double inside = std::clamp(at[a], -0.5, cells[a] - 0.5);
        first[a] = std::clamp(static_cast<int>(std::floor(inside)), 0, std::max(cells[a] - 2, 0));
        f[a] = cells[a] > 1 ? static_cast<float>(inside - first[a]) : 0.0f;
    }
    const std::size_t i = index(first), dx = cells.x > 1 ? 1 : 0,
                      dy = cells.y > 1 ? static_cast<std::size_t>(cells.x) : 0,
                      dz = cells.z > 1 ? static_cast<std::size_t>(cells.x * cells.y) : 0;
    const auto row = [&](std::size_t j) { return (1 - f.x) * values[j] + f.x * values[j + dx]; };
    const auto plane = [&](std::size_t j) { return (1 - f.y) * row(j) + f.y * row(j + dy); };
    return (1 - f.z) * plane(i) + f.z * plane(i + dz);
}

Vec3f ZoneGrid::depth(const Ray& ray) const {
    Vec3f sum;
    walk_zones(*this, ray.origin, ray.direction, ray.t_max,
               [&](std::size_t i, float length) { sum += length * extinction[i]; });
    return sum;
}

double ZoneGrid::thickness() const {
    float most = 0;
    for (const Vec3f& e : extinction) most = std::max(most, max_component(e));
    return static_cast<double>(most) * max_component(cell_size());
}

ZoneGrid make_zones(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                    const Vec3i& cells, int points, ZoneScattering scattering, Job& job) {
    const MatterGrid matter = bake_matter(media, box, cells, points, job);
    ZoneGrid grid;
    grid.box = box;
    grid.cells = cells;
    grid.extinction.resize(volume(cells));
    grid.scattering.resize(volume(cells));
    grid.emission = matter.emission;
    for (std::size_t m = 0; m < media.size(); ++m) {
        const CrossSections& cross = media[m]->cross_sections();
        const float kept = scattering == ZoneScattering::Plain
                               ? 1
                               : static_cast<float>(1 - mean_cosine(media[m]->phase()));
        const MatterGrid::Matter& of = matter.media[m];
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const float density = of.density[i];
            if (density == 0) continue;
            // What a colour takes from the scattering is absorbed.
            const Vec3f all = density * cross.scattering;
            const Vec3f scattered = of.color.empty() ? all : all * of.color[i];
            grid.scattering[i] += kept * scattered;
            grid.extinction[i] += density * cross.absorption + (all - scattered) + kept * scattered;
        }
    }
    for (const Vec3f& e : grid.extinction) {
        grid.is_grey = grid.is_grey && e.x == e.y && e.y == e.z;
    }
    return grid;
}

Vec3i zone_cells(const Box3d& box, int along) {
    const Vec3d size = box.size();
    const double edge = max_component(size) / along;
    Vec3i cells;
    for (int a = 0; a < 3; ++a)
        cells[a] = std::max(1, static_cast<int>(std::lround(size[a] / edge)));
    return cells;
}

}  // namespace gischt
