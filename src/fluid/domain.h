// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "fluid/side_values.h"
#include "grid/gather.h"
#include "math/transform.h"
#include "schema/table.h"
#include "solve/poisson.h"

namespace gischt {

// The box in which a fluid is simulated, in metres.
struct DomainParams {
    int resolution = 64;               // cells along the longest edge
    Vec3d min{0, 0, 0}, max{1, 1, 1};  // no extent along z: 2-D, one cell thick
    SideKind x_min = SideKind::Open, x_max = SideKind::Open, y_min = SideKind::Open,
             y_max = SideKind::Open, z_min = SideKind::Open, z_max = SideKind::Open;
    SidesParams sides;

    void set_all_sides(SideKind kind) { x_min = x_max = y_min = y_max = z_min = z_max = kind; }
};
const Table<DomainParams>& domain_table();

// Cells and sides of a domain. Edges that are no whole number of cells are rounded to one, with
// `min` kept; in 2-D the cells' centres lie in the plane z = min.z.
struct Domain {
    TileMap::Ptr map;
    Vec3i cells;
    double h = 0;  // edge of a cell, m
    Vec3d origin;  // corner of cell (0,0,0), m
    std::array<SideKind, 6> side{};
    std::array<SideParams, 6> sides;
    SideValues held;  // at the present moment; in the beginning nothing but zeros

    // Throws Error{Usage} on an empty box, on more cells than a grid takes, on a periodic side
    // whose opposite is not, and as check_sides() does.
    explicit Domain(const DomainParams& params);

    bool is_2d() const { return map->is_2d(); }
    int axes() const { return is_2d() ? 2 : 3; }
    SideKind side_of(int axis, int end) const {
        return side[static_cast<std::size_t>(2 * axis + end)];
    }
    bool is_periodic(int axis) const { return side_of(axis, 0) == SideKind::Periodic; }
    double cell_volume() const { return h * h * h; }
    Vec3d center_of(const Vec3i& cell) const { return origin + h * (Vec3d(cell) + Vec3d(0.5)); }
    // Centre of the lower face of a cell along an axis.
    Vec3d face_center(int axis, const Vec3i& cell) const {
        Vec3d p = center_of(cell);
        p[axis] -= 0.5 * h;
        return p;
    }
    Transform to_world() const { return Transform::scale_translate(h, origin); }

    // The lower faces of cells along an axis, and the upper ones where the domain ends.
    Box3i faces_of(Box3i box, int axis) const {
        if (box.hi[axis] == cells[axis]) box.hi[axis] += 1;
        return box;
    }

    // How quantities continue beyond the sides, but for what is `held` there. Scalars are stored as
    // deviations from the ambient, so that zero flows in where a side is open; walls are insulated.
    Borders scalar_borders() const;
    // Component `axis` of the velocity: zero gradient at open sides, mirrored at walls; beyond an
    // inflow as on it.
    Borders velocity_borders(int axis) const;
    // Zero outside open sides, without a gradient at walls and inflows.
    Borders pressure_borders() const;
    Sides pressure_sides() const;
};

}  // namespace gischt
