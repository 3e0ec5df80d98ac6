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

// What several media are in the cells of a regular grid, in the order of ExtinctionGrid: all that
// methods on graphics hardware need. A medium's coefficients are its constant cross sections times
// the density, and for scattering times the colour too.
struct MatterGrid {
    Box3d box;    // metres
    Vec3i cells;  // along each axis
    struct Matter {
        std::vector<float> density;
        std::vector<Vec3f> color;  // weighed by density; empty where the medium has none
    };
    std::vector<Matter> media;    // in the order given
    std::vector<Vec3f> emission;  // of all media, W/(m^3 sr); empty where none glows
};

// Means of points^3 points per cell. Throws Error{Usage} for an empty box or no cells.
MatterGrid bake_matter(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                       const Vec3i& cells, int points, Job& job);

// The mean extinction of each cell of `box`, all media together, from `points`^3 points per cell.
// For methods that need a regular grid. Throws Error{Usage} for an empty box or no cells.
ExtinctionGrid bake(std::span<const std::shared_ptr<const Medium>> media, const Box3d& box,
                    const Vec3i& cells, int points, Job& job);

}  // namespace gischt
