// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/diffusion.h"
#include "solve/stencil_solver.h"

namespace gischt {

// One system (1 + number L) x' = x + number (what the sides and solids hold), divided by number so
// that it is the shifted operator of a StencilSpec. Shared by scalars and velocity components.
class DiffusionStep {
  public:
    // `spec`: map, sides, fraction and extra; the shift and the number of levels are set here.
    DiffusionStep(StencilSpec spec, double number);

    // True where the number is so small that x does not change in float.
    bool is_identity() const { return number_ < 1e-9; }

    // The old values; replaces everything added before.
    void set_right_hand_side(const TileField<float>& x);
    // Adds, for every cell along a Fixed side, what it holds: value(cell), times an open fraction
    // where there is one. Other sides are skipped.
    template <class F>
    void add_side(int axis, int end, F&& value) {
        const SideRule& side = spec_.sides[static_cast<std::size_t>(2 * axis + end)];
        if (side.kind != SideRule::Kind::Fixed) return;
        const Vec3i n = spec_.map->bounds().size();
        Vec3i lo, hi = n;
        lo[axis] = end == 0 ? 0 : n[axis] - 1;
        hi[axis] = lo[axis] + 1;
        const auto weight = static_cast<float>(1 / side.distance);
        for (int k = lo.z; k < hi.z; ++k) {
            for (int j = lo.y; j < hi.y; ++j) {
                for (int i = lo.x; i < hi.x; ++i) {
                    b_.ref({i, j, k}) += weight * value(Vec3i(i, j, k));
                }
            }
        }
    }
    TileField<float>& right_hand_side() { return b_; }

    SolveResult solve(TileField<float>& x, const SolveLimits& limits, Job& job);

  private:
    StencilSpec spec_;
    double number_;
    TileField<float> b_;
};

}  // namespace gischt
