// SPDX-License-Identifier: Apache-2.0
#include "studio/estimate.h"

#include <filesystem>

#include "base/error.h"
#include "fluid/particles/particle_source.h"
#include "fluid/procedural/procedural.h"
#include "scene/world.h"
#include "studio/cache.h"

namespace gischt {
namespace {

// Measured on the plume at 128 cells with two cores of 2.45 GHz: see `scripts/bench fluid` and
// `scripts/bench light`.
constexpr double bytes_per_cell = 150, seconds_per_cell = 3.0e-7, disk_bytes_per_cell = 2.0;
constexpr double seconds_per_cloud_cell = 1.5e-7, seconds_per_sample = 2.0e-6;
// In eddies of two octaves, and to a density and a file: `scripts/bench particle`.
constexpr double seconds_per_particle_step = 3e-7, seconds_per_particle = 1.5e-6;
// Of a cell of a procedural fluid, half of the processor's time on one core: its shape, an octave
// of gradient noise, an octave of cell noise.
constexpr double seconds_per_shape = 5e-8, seconds_per_octave = 4.3e-8,
                 seconds_per_cell_octave = 9e-7;
// Of the cells, those whose noise is computed where it only moves a surface: as in `cumulus`.
constexpr double share_near_surface = 0.15;

struct Estimator {
    const Scene& scene;

    FluidEstimate operator()(const FluidOf<SmokeParams>& f) const {
        const Domain domain(f.source.domain);
        FluidEstimate e;
        e.source = "smoke";
        e.cells = domain.cells;
        e.cell_size = domain.h;
        const auto cells = static_cast<double>(volume(domain.cells));
        e.memory = bytes_per_cell * cells;
        e.disk_per_frame = disk_bytes_per_cell * cells;
        e.seconds_per_frame = seconds_per_cell * cells * f.source.min_substeps;
        return e;
    }
    FluidEstimate operator()(const FluidOf<FileParams>& f) const {
        const std::string file = file_of_frame(f.source, scene.frames.x);
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored))
            throw Error(ErrorKind::Input, file, "no such file");
        FluidEstimate e;
        e.source = "file";
        e.memory = 8 * static_cast<double>(std::filesystem::file_size(file));
        return e;
    }
    FluidEstimate operator()(const FluidOf<CloudParams>& f) const {
        return box_filled("cloud", f.source, 1, seconds_per_cloud_cell);
    }
    FluidEstimate operator()(const FluidOf<ProceduralParams>& f) const {
        const ProceduralParams& p = f.source;
        const int fields =
            1 + p.temperature.has_value() + p.flame.has_value() + p.surface + 3 * is_moving(p);
        const double share = p.threshold ? 1 : share_near_surface;
        return box_filled("procedural", p, fields, seconds_per_shape + share * seconds_of(p.noise));
    }

    FluidEstimate operator()(const FluidOf<ParticleParams>& f) const {
        const SplatLattice lattice = splat_lattice(f.source.domain);
        FluidEstimate e;
        e.source = "particles";
        e.cell_size = lattice.h;
        e.cells = lattice.cells;
        double count = 0;
        for (const SpoutParams& s : f.source.sources) count += most_alive(s);
        e.memory = 400 * count + 4 * static_cast<double>(volume(e.cells));
        e.disk_per_frame = 60 * count;
        e.seconds_per_frame =
            (seconds_per_particle_step * f.source.substeps + seconds_per_particle) * count;
        return e;
    }

  private:
    // Of noise at a point; to warp it takes three further ones.
    static double seconds_of(const TurbulenceParams& noise) {
        const bool is_of_cells =
            noise.kind == TurbulenceKind::Cells || noise.kind == TurbulenceKind::Walls;
        const bool is_warped = !noise.warp.is_constant() || noise.warp.at(0) != 0;
        return (is_of_cells ? seconds_per_cell_octave : seconds_per_octave) * noise.octaves +
               (is_warped ? 3 * seconds_per_octave : 0);
    }

    // At most: as if every cell of the box were filled.
    template <class P>
    static FluidEstimate box_filled(const char* source, const P& p, int fields,
                                    double seconds_per_cell_here) {
        FluidEstimate e;
        e.source = source;
        e.cell_size = max_component(p.max - p.min) / p.resolution;
        e.cells = max(floor((p.max - p.min) / e.cell_size + Vec3d(0.5)), Vec3i(2));
        const auto cells = static_cast<double>(volume(e.cells));
        e.memory = 4 * fields * cells;
        e.disk_per_frame = disk_bytes_per_cell * fields * cells;
        e.seconds_per_frame = seconds_per_cell_here * cells;
        return e;
    }
};

}  // namespace

std::vector<FluidEstimate> estimate_fluids(const Scene& scene) {
    std::vector<FluidEstimate> estimates;
    const std::vector<std::string> names = fluid_names(scene);
    for (std::size_t i = 0; i < scene.fluids.size(); ++i) {
        estimates.push_back(std::visit(Estimator{scene}, scene.fluids[i]));
        estimates.back().name = names[i];
    }
    return estimates;
}

double estimate_picture_seconds(const Scene& scene) {
    return seconds_per_sample * scene.film.width * scene.film.height * scene.render.spp;
}

}  // namespace gischt
