// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "base/job.h"
#include "math/box.h"
#include "math/transform.h"

namespace gischt {

struct MarchScene;

// The light of the whole sky (constant, environment map) that a medium scatters towards the camera,
// on a grid: integral of radiance, transmittance and phase function over all directions, per
// scattering coefficient, with the octaves of approximate multiple scattering. It is smooth and
// deterministic: no noise, no flicker.
//
// The sky is divided into parts (sky_directions); for each the transmittance is swept through the
// grid plane by plane, a node taking the bilinear mean of the four upwind nodes that its ray passes
// between (short characteristics, Kunasz & Auer 1988). That smears each part's shadows a little,
// which the mean over all parts hides. Surfaces block.
class SkyGrid {
  public:
    // For medium `index` of the scene. Costs about 10 ns per node and direction.
    SkyGrid(const MarchScene& scene, std::size_t index, Job& job);

    // W/(m^2 sr) at a point in metres; outside of the medium's box that of the nearest node.
    Vec3f operator()(const Vec3d& point) const;

  private:
    friend class SkySweep;

    std::size_t node(int i, int j, int k) const {
        return static_cast<std::size_t>(i) +
               static_cast<std::size_t>(n_.x) *
                   (static_cast<std::size_t>(j) +
                    static_cast<std::size_t>(n_.y) * static_cast<std::size_t>(k));
    }

    Transform to_world_, to_lattice_;  // node (i,j,k) lies at (i,j,k)
    Vec3i n_;
    std::vector<std::array<float, 4>> light_;  // red, green, blue, unused: one vector register
};

}  // namespace gischt
