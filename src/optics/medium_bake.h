// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "optics/medium.h"

namespace gischt {

// Extinction of the strongest channel on a regular grid, 1/m, constant in each cell; x fastest,
// then y, then z.
struct ExtinctionGrid {
    Box3d box;    // metres
    Vec3i cells;  // along each axis
    std::vector<float> extinction;

    Vec3d cell_size() const { return box.size() / Vec3d(cells); }
    std::size_t index(const Vec3i& c) const {
        return static_cast<std::size_t>(c.x) +
               static_cast<std::size_t>(cells.x) *
                   (static_cast<std::size_t>(c.y) +
                    static_cast<std::size_t>(cells.y) * static_cast<std::size_t>(c.z));
    }
    Vec3d center(const Vec3i& c) const { return box.lo + (Vec3d(c) + Vec3d(0.5)) * cell_size(); }
};

// The mean extinction of each cell of `box`, all media together, from `points`^3 points per cell.
// For methods that need a regular grid. Throws Error{Usage} for an empty box or no cells.
ExtinctionGrid bake(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                    const Vec3i& cells, int points, Job& job);

}  // namespace gischt
