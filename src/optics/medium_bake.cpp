// SPDX-License-Identifier: Apache-2.0
#include "optics/medium_bake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "optics/medium_depth.h"

namespace gischt {
namespace {

void check_grid(const Box3d& box, const Vec3i& cells, int points) {
    if (box.is_empty() || min_component(cells) < 1 || points < 1) {
        throw Error(ErrorKind::Usage, "bake", "the box or its number of cells is empty");
    }
}

// Adds what a medium is at start + i step, i < count, to cells of `points` samples each.
struct CellRow {
    std::span<float> density;
    std::span<Vec3f> color, emission;  // may be empty
    int points = 1;
    float weight = 1;

    void add(const Medium& medium, const Ray& line) const {
        const double count = static_cast<double>(density.size()) * points;
        SegmentWalk walk =
            medium.segments({line.origin, line.direction, -0.5, count - 0.5}, BrickGrain::Bricks);
        MediumSegment s;
        while (walk.next(s)) {
            const int end = static_cast<int>(std::clamp(std::ceil(s.t1), 0.0, count));
            int i = static_cast<int>(std::clamp(std::ceil(s.t0), 0.0, count));
            for (; i < end; i += batch) add_batch(medium, s, i, std::min(end - i, batch));
        }
    }

  private:
    static constexpr int batch = 32;

    void add_batch(const Medium& medium, const MediumSegment& s, int first, int count) const {
        std::array<float, batch> t, value;
        std::array<Vec3f, batch> glow;
        const auto n = static_cast<std::size_t>(count);
        for (std::size_t k = 0; k < n; ++k) {
            t[k] = static_cast<float>(first + static_cast<int>(k) - s.anchor);
        }
        medium.densities(s, {t.data(), n}, value.data());
        if (!emission.empty()) medium.emissions(s, {t.data(), n}, value.data(), glow.data());
        for (std::size_t k = 0; k < n; ++k) {
            const auto cell = static_cast<std::size_t>((first + static_cast<int>(k)) / points);
            density[cell] += weight * value[k];
            if (!emission.empty()) emission[cell] += weight * glow[k];
            if (!color.empty()) {
                color[cell] += weight * value[k] * medium.color_at(s, t[k], value[k]);
            }
        }
    }
};

}  // namespace

MatterGrid bake_matter(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                       const Vec3i& cells, int points, Job& job) {
    check_grid(box, cells, points);
    MatterGrid grid{box, cells, {}, {}};
    const std::size_t n = volume(cells), nx = static_cast<std::size_t>(cells.x);
    for (const auto& medium : media) {
        grid.media.push_back({std::vector<float>(n), {}});
        if (medium->has_color()) grid.media.back().color.resize(n);
        if (medium->is_emissive()) grid.emission.resize(n);
    }
    const Vec3d step = box.size() / (static_cast<double>(points) * Vec3d(cells));
    parallel_for(cells.y * cells.z, 4, [&](int row) {
        job.check();
        const int j = row % cells.y, k = row / cells.y;
        const std::size_t first = static_cast<std::size_t>(row) * nx;
        for (std::size_t m = 0; m < media.size(); ++m) {
            MatterGrid::Matter& out = grid.media[m];
            const bool glows = media[m]->is_emissive(), is_dyed = media[m]->has_color();
            const CellRow cell_row{
                {out.density.data() + first, nx},
                is_dyed ? std::span(out.color.data() + first, nx) : std::span<Vec3f>(),
                glows ? std::span(grid.emission.data() + first, nx) : std::span<Vec3f>(),
                points,
                static_cast<float>(1.0 / (points * points * points))};
            for (int s = 0; s < points * points; ++s) {
                const Vec3d start(0.5, j * points + s % points + 0.5,
                                  k * points + s / points + 0.5);
                cell_row.add(*media[m], {box.lo + start * step, {step.x, 0, 0}});
            }
            for (std::size_t i = first; is_dyed && i < first + nx; ++i) {
                if (out.density[i] > 0) out.color[i] = out.color[i] / Vec3f(out.density[i]);
            }
        }
    });
    return grid;
}

ExtinctionGrid bake(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                    const Vec3i& cells, int points, Job& job) {
    check_grid(box, cells, points);
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
