// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/job.h"
#include "math/ray.h"
#include "optics/medium.h"

namespace gischt {

// Media as zones: the cells of a regular grid, each filled evenly. x fastest, then y, then z.
struct ZoneGrid {
    Box3d box;                                  // metres
    Vec3i cells;                                // along each axis
    std::vector<Vec3f> extinction, scattering;  // 1/m
    std::vector<Vec3f> emission;                // a L_e, W/(m^3 sr); empty where nothing glows
    bool is_grey = true;                        // the extinction is the same in all channels

    // Filled evenly.
    static ZoneGrid even(const Box3d& box, const Vec3i& cells, float extinction, float albedo);

    std::size_t size() const { return extinction.size(); }
    Vec3d cell_size() const { return box.size() / Vec3d(cells); }
    std::size_t index(const Vec3i& c) const {
        return static_cast<std::size_t>(c.x) +
               static_cast<std::size_t>(cells.x) *
                   (static_cast<std::size_t>(c.y) +
                    static_cast<std::size_t>(cells.y) * static_cast<std::size_t>(c.z));
    }
    Vec3i cell(std::size_t index) const {
        const int i = static_cast<int>(index);
        return {i % cells.x, i / cells.x % cells.y, i / cells.x / cells.y};
    }
    // The cell of a point, or the nearest one.
    Vec3i cell_at(const Vec3d& point) const {
        const Vec3i c = floor((point - box.lo) / cell_size());
        return min(max(c, Vec3i(0)), cells - Vec3i(1));
    }
    // Trilinear between the centres of the cells and on to the sides of the box, constant beyond;
    // the first one not below 0.
    Vec3f interpolate(std::span<const Vec3f> values, const Vec3d& point) const {
        return max(interpolate_signed(values, point), Vec3f(0));
    }
    Vec3f interpolate_signed(std::span<const Vec3f> values, const Vec3d& point) const;
    // Optical depth along a ray from a point of the box until t_max or out of it, t in metres.
    Vec3f depth(const Ray& ray) const;
    // Optical thickness of the thickest zone across its longest edge, strongest channel.
    double thickness() const;
};

// How scattering enters the zones.
enum class ZoneScattering {
    Plain,    // as it is
    Reduced,  // times 1 - g, as if it were even: the similarity relation (van de Hulst 1980, ch.
              // 14)
};

// The mean coefficients of each cell, from points^3 points per cell: optical depths are kept in the
// mean. Throws Error{Usage} for an empty box or no cells.
ZoneGrid make_zones(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                    const Vec3i& cells, int points, ZoneScattering scattering, Job& job);

// Nearly cubic cells of a box, so many along its longest edge.
Vec3i zone_cells(const Box3d& box, int along);

// Through the zones along a straight line from a point of the box: calls visit(index, length) for
// each of them until t_end (metres), or out of the box.
template <class Visit>
void walk_zones(const ZoneGrid& grid, const Vec3d& from, const Vec3d& direction, double t_end,
                Visit&& visit) {
    const Vec3d h = grid.cell_size();
    Vec3i c = grid.cell_at(from);
    Vec3d next, step;
    for (int a = 0; a < 3; ++a) {
        const double d = direction[a];
        step[a] = d == 0 ? 0 : h[a] / std::abs(d);
        const double wall = grid.box.lo[a] + (c[a] + (d > 0 ? 1 : 0)) * h[a];
        next[a] =
            d == 0 ? std::numeric_limits<double>::infinity() : std::max((wall - from[a]) / d, 0.0);
    }
    for (double t = 0;;) {
        const int a = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
        const double end = std::min(next[a], t_end);
        if (end > t) visit(grid.index(c), static_cast<float>(end - t));
        if (next[a] >= t_end) return;
        t = end;
        c[a] += direction[a] > 0 ? 1 : -1;
        if (c[a] < 0 || c[a] >= grid.cells[a]) return;
        next[a] += step[a];
    }
}

}  // namespace gischt
