// SPDX-License-Identifier: Apache-2.0
#include "solve/diffusion.h"

#include "solve/diffusion_step.h"

namespace gischt {
namespace {

SideRule scalar_rule(Border border) {
    switch (border) {
        case Border::Odd:
            return {SideRule::Kind::Fixed, 0.5};
        case Border::Zero:
            return {SideRule::Kind::Fixed, 1.0};
        case Border::Periodic:
            return {SideRule::Kind::Periodic, 1.0};
        default:
            return {SideRule::Kind::Closed, 1.0};
    }
}

}  // namespace

SolveResult diffuse(TileField<float>& x, double number, const ScalarSides& sides,
                    const FaceField* fraction, const SolveLimits& limits, Job& job) {
    StencilSpec spec;
    spec.map = x.map_ptr();
    spec.fraction = fraction;
    for (std::size_t s = 0; s < 6; ++s) spec.sides[s] = scalar_rule(sides.rule.side[s]);
    DiffusionStep step(spec, number);
    if (step.is_identity()) return {0, 0, true};

    step.set_right_hand_side(x);
    const Vec3i n = x.map().bounds().size();
    for (int a = 0; a < (x.map().is_2d() ? 2 : 3); ++a) {
        for (int end = 0; end < 2; ++end) {
            const float value = sides.value[static_cast<std::size_t>(2 * a + end)];
            step.add_side(a, end, [&](const Vec3i& cell) {
                if (fraction == nullptr) return value;
                Vec3i face = cell;
                face[a] = end == 0 ? 0 : n[a];
                return value * fraction->get(a, face);
            });
        }
    }
    return step.solve(x, limits, job);
}

}  // namespace gischt
