// SPDX-License-Identifier: Apache-2.0
#include "render/path/dense_run.h"

#include <algorithm>
#include <array>

namespace gischt {

// In place of infinity, which must not meet a 0.
static constexpr float endless = 1e30f;
static constexpr float gauss = 0.211324865f;  // (1 - 1/sqrt(3)) / 2

double exact_integral(const Medium& medium, const MediumSegment& segment, std::int64_t& lookups) {
    std::array<float, most_cell_crossings> edge;
    std::array<float, 2 * most_cell_crossings + 2> t, density;
    const auto last = static_cast<float>(segment.t1 - segment.anchor);
    float begin = static_cast<float>(segment.t0 - segment.anchor);
    const int n = medium.cell_crossings_of(segment, begin, last, edge);
    std::size_t count = 0;
    const auto end_of = [&](int i) { return i < n ? edge[static_cast<std::size_t>(i)] : last; };
    for (int i = 0; i <= n; ++i) {
        const float reach = end_of(i) - begin;
        t[count++] = begin + gauss * reach;
        t[count++] = begin + (1 - gauss) * reach;
        begin += reach;
    }
    medium.densities(segment, {t.data(), count}, density.data());
    lookups += static_cast<std::int64_t>(count);
    begin = static_cast<float>(segment.t0 - segment.anchor);
    float sum = 0;
    for (int i = 0; i <= n; ++i) {
        const auto k = static_cast<std::size_t>(2 * i);
        sum += 0.5f * (end_of(i) - begin) * (density[k] + density[k + 1]);
        begin = end_of(i);
    }
    return static_cast<double>(sum);
}

Vec3f exact_depth_of_run(const MediaRun& run, std::int64_t& lookups) {
    Vec3f depth;
    for (const ActiveMedium& a : run.active) {
        MediumSegment part = a.segment;
        part.t0 = run.t0;
        part.t1 = run.t1;
        depth += static_cast<float>(exact_integral(*a.medium, part, lookups)) *
                 a.medium->cross_sections().extinction();
    }
    return min(depth, Vec3f(endless));
}

bool has_cells(const MediaRun& run) {
    return std::all_of(run.active.begin(), run.active.end(), [](const ActiveMedium& a) {
        return a.segment.brick >= 0 || a.segment.min == a.segment.max;
    });
}

void cells_of_run(const MediaRun& run, double t, std::vector<RunCell>& cells,
                  std::int64_t& lookups) {
    // The walls of the cells of all media.
    const auto length = static_cast<float>(std::min(run.t1 - t, static_cast<double>(endless)));
    std::array<float, most_media * most_cell_crossings + 1> wall;
    std::size_t walls = 0;
    for (const ActiveMedium& a : run.active) {
        const auto begin = static_cast<float>(t - a.segment.anchor);
        const int n = a.medium->cell_crossings_of(a.segment, begin, begin + length,
                                                  {wall.data() + walls, most_cell_crossings});
        for (int i = 0; i < n; ++i) wall[walls++] -= begin;
    }
    std::sort(wall.begin(), wall.begin() + static_cast<std::ptrdiff_t>(walls));
    wall[walls++] = length;

    cells.clear();
    float begin = 0;
    for (std::size_t i = 0; i < walls; ++i) {
        if (!(wall[i] > begin)) continue;
        RunCell cell{t + static_cast<double>(begin), wall[i] - begin, {}};
        cell.depth = depth_within_cell(run, cell, cell.length, lookups);
        cells.push_back(cell);
        begin = wall[i];
    }
}

Vec3f depth_within_cell(const MediaRun& run, const RunCell& cell, float s, std::int64_t& lookups) {
    Vec3f depth;
    for (const ActiveMedium& a : run.active) {
        const auto begin = static_cast<float>(cell.t - a.segment.anchor);
        const float sum = a.medium->density_at(a.segment, begin + gauss * s) +
                          a.medium->density_at(a.segment, begin + (1 - gauss) * s);
        depth += 0.5f * s * sum * a.medium->cross_sections().extinction();
        lookups += 2;
    }
    return min(depth, Vec3f(endless));
}

}  // namespace gischt
