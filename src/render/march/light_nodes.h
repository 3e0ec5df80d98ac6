// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "optics/medium.h"
#include "optics/surface.h"

namespace gischt {

// The nodes of a grid of light over a medium, and what is known of them before any light.
struct LightNodes {
    Vec3i n;                                     // zero where the medium is empty
    Transform to_world;                          // node (i,j,k) lies at (i,j,k)
    std::vector<std::vector<float>> extinction;  // 1/m; set to one or three channels of zeros
    std::vector<std::uint8_t> is_needed;         // light is asked for near the node
    std::vector<std::uint8_t> is_opaque;         // a surface passes through its cell

    // Every `spacing`-th voxel of the medium's lattice, over its whole box.
    LightNodes(const Medium& medium, double spacing);

    std::size_t index(int i, int j, int k) const {
        return static_cast<std::size_t>(i) +
               static_cast<std::size_t>(n.x) *
                   (static_cast<std::size_t>(j) +
                    static_cast<std::size_t>(n.y) * static_cast<std::size_t>(k));
    }

    // Adds the extinction of a medium, averaged over eight points around each node; where the
    // medium is the target, nodes with any become needed.
    void add(const Medium& medium, bool is_target);
    // A look-up beside a needed node reads its neighbours: one node more on all sides.
    void widen_needed();
    // Does nothing where there are no surfaces.
    void find_opaque(const SurfaceSet& surfaces);
};

}  // namespace gischt
