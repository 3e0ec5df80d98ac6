// SPDX-License-Identifier: Apache-2.0
#include "optics/medium_bake.h"

#include "base/parallel.h"
#include "optics/medium_depth.h"

namespace gischt {

ExtinctionGrid bake(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                    const Vec3i& cells, int points, Job& job) {
    if (box.is_empty() || min_component(cells) < 1 || points < 1) {
        throw Error(ErrorKind::Usage, "bake", "the box or its number of cells is empty");
    }
    ExtinctionGrid grid{box, cells, std::vector<float>(volume(cells))};
    const Vec3d step = grid.cell_size() / Vec3d(points);
    const auto nx = static_cast<std::size_t>(cells.x), n = static_cast<std::size_t>(points);
    const auto weight = static_cast<float>(1.0 / (points * points * points));
    parallel_for(cells.y * cells.z, 4, [&](int row) {
        job.check();
        const int j = row % cells.y, k = row / cells.y;
        float* out = grid.extinction.data() + grid.index({0, j, k});
        std::vector<float> line(nx * n);
        for (const auto& medium : media) {
            const float scale = weight * medium->strength();
            for (int s = 0; s < points * points; ++s) {
                const Vec3d start =
                    box.lo +
                    Vec3d(0.5, j * points + s % points + 0.5, k * points + s / points + 0.5) * step;
                densities_on_line(*medium, {start, {step.x, 0, 0}}, 0, 1, line);
                for (std::size_t i = 0; i < line.size(); ++i) out[i / n] += scale * line[i];
            }
        }
    });
    return grid;
}

}  // namespace gischt
