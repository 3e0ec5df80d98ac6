// SPDX-License-Identifier: Apache-2.0
#include "scene/file_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "fluid/particles/splat.h"

namespace gischt {

const Table<FilePoints>& file_points_table() {
    using P = FilePoints;
    static const Table<P> table =
        Table<P>("file_points", "How particles become a density, in files without fields")
            .add("cell_size", &P::cell_size,
                 {.unit = "m",
                  .help = "Edge of a cell; 0 takes 1/256 of the longest edge of their box",
                  .min = 0})
            .add("density", &P::density,
                 {.help = "Density of the field inside of a particle", .min = 0})
            .add("splat_scale", &P::splat_scale,
                 {.help = "Radius over which a particle is spread, against its own; it is at "
                          "least 1.5 cells",
                  .min = 0,
                  .min_open = true})
            .add("foreign", &P::foreign,
                 {.help = "Read points in VDB files of other programs too; such a file cannot be "
                          "checked, and a damaged one may end gischt"});
    return table;
}

// The cells around all particles and their kernels.
static SplatLattice lattice_around(const FilePoints& params, const Particles& particles) {
    const Box3d box = particles.bounds();
    const float largest = *std::ranges::max_element(particles.radius);
    const double reach = params.splat_scale * std::max(0.0, static_cast<double>(largest));
    const double longest = max_component(box.size()) + 2 * reach;
    double h = params.cell_size > 0 ? params.cell_size : longest / 256;
    if (!(h > 0)) h = 0.01;  // a single point without extent
    // Two cells more hold the least kernel, of 1.5.
    const Vec3d lo = box.lo - Vec3d(reach + 2 * h);
    const Vec3d cells = (box.size() + Vec3d(2 * reach)) / h + Vec3d(4);
    if (!(cells.x * cells.y * cells.z < 0x1p31)) {
        throw Error(ErrorKind::Usage, "points",
                    fmt::format("a box of {:.4g} m has too many cells of {:.4g} m", longest, h),
                    "raise 'cell_size'");
    }
    return {floor(cells) + Vec3i(1), h, lo};
}

void splat_file_points(const FilePoints& params, Frame& frame, Job& job) {
    if (frame.particles.size() > 1) {
        std::string names;
        for (const auto& [name, set] : frame.particles) names += (names.empty() ? "" : ", ") + name;
        throw Error(ErrorKind::Input, "points", "the file has several sets of particles: " + names,
                    "write one file per set");
    }
    for (const auto& [name, set] : frame.particles) {
        if (set.is_empty()) continue;
        splat_particles(set, lattice_around(params, set), {params.density, params.splat_scale},
                        frame, job);
    }
}

}  // namespace gischt
