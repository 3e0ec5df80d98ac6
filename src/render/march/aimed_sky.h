// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "optics/light.h"

namespace gischt {

// Draws directions of a broad light at infinity in proportion to radiance times cosine on surfaces.
// Light::sample() maps a square to directions in proportion to radiance; that square is divided
// into 16 x 16 cells, which are chosen by the mean cosine of their directions and filled evenly.
class AimedSky {
  public:
    explicit AimedSky(const Light& light);

    // Chooses the surface's unit normal: 256 dot products unless it is the one before.
    void aim(const Vec3d& normal);

    // A direction for u in [0,1)^2: its share of the irradiance is weight / number of directions.
    struct Direction {
        Vec3d towards;  // unit
        Vec3f weight;   // radiance * cosine / density, W/m^2; zero below the surface
    };
    Direction operator()(Vec2f u) const;

  private:
    static constexpr int edge = 16, cells = edge * edge;

    const Light* light_;
    std::array<float, cells> x_, y_, z_, spread_;  // of each cell: mean direction, largest distance
    std::optional<Vec3d> normal_;
    std::array<float, cells> until_;     // sums of the cells' probability along each row
    std::array<float, edge> row_until_;  // and of the rows'
};

}  // namespace gischt
