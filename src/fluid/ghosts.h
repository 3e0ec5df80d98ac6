// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "grid/field.h"

namespace gischt {

// The points of a lattice (cell centres, or faces along one axis) that lie in solids, and how
// values are continued to them: each point of layer n takes the mean of its neighbours in earlier
// layers, layer 0 being the fluid. Found once per position of the solids, applied every step.
class Ghosts {
  public:
    // Points of `region`, which must be existing points; `is_covered` says which are in a solid.
    // Face lattices have `axis` >= 0. Points in more than `layers` layers are `deep`.
    void find(const TileMap& map, int axis, const Box3i& region, int layers,
              const std::function<bool(const Vec3i&)>& is_covered);

    // `last`: the upper faces of a face lattice, null for cells.
    void extrapolate(TileField<float>& values, AlignedVector<float>* last) const;

    const std::vector<Vec3i>& points() const { return points_; }
    const std::vector<Vec3i>& deep() const { return deep_; }

  private:
    struct Rule {
        std::size_t target = 0;
        int count = 0;
        std::array<std::size_t, 6> from{};
    };
    std::vector<Vec3i> points_, deep_;
    std::vector<Rule> rules_;             // of points_, in the order of the layers
    std::vector<std::size_t> layer_end_;  // in rules_
};

}  // namespace gischt
