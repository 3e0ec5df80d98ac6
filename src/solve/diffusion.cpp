// SPDX-License-Identifier: Apache-2.0
#include "solve/diffusion.h"

#include <optional>

#include "base/parallel.h"
#include "solve/diffusion_step.h"
#include "solve/surface_links.h"

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

// Cells in solids that hold a value, and what they hold; fractions of faces elsewhere.
SurfaceLinks links_of(const TileField<float>& x, const ScalarSolids& solids, const Borders& sides) {
    Borders borders;
    for (std::size_t s = 0; s < 6; ++s) {
        borders.side[s] = sides.side[s] == Border::Periodic ? Border::Periodic : Border::Clamp;
    }
    SurfaceLinks links(x.map_ptr(), borders, true);
    if (solids.fraction != nullptr) links.weight = *solids.fraction;
    const TileMap& map = x.map();
    const Vec3i halo{1, 1, map.is_2d() ? 0 : 1};
    parallel_for(map.size(), 16, [&](int t) {
        const Box3i cells = map.cells_of(t);
        TileSurroundings around{{cells.lo - halo, cells.hi + halo}, {}, {}};
        around.distance.resize(volume(around.cells.size()));
        gather(*solids.distance, around.cells, borders, around.distance.data());
        if (around.is_open()) return;
        if (solids.value != nullptr) {
            around.value.resize(around.distance.size());
            gather(*solids.value, around.cells, borders, around.value.data());
        }
        links.link(t, around);
    });
    return links;
}

}  // namespace

SolveResult diffuse(TileField<float>& x, double number, const ScalarSides& sides,
                    const ScalarSolids& solids, const SolveLimits& limits, Job& job) {
    std::optional<SurfaceLinks> links;
    if (solids.distance != nullptr) links.emplace(links_of(x, solids, sides.rule));
    const FaceField* fraction = links ? &links->weight : solids.fraction;
    StencilSpec spec;
    spec.map = x.map_ptr();
    spec.fraction = fraction;
    if (links) spec.extra = &links->extra;
    for (std::size_t s = 0; s < 6; ++s) spec.sides[s] = scalar_rule(sides.rule.side[s]);
    DiffusionStep step(spec, number);
    if (step.is_identity()) return {0, 0, true};

    step.set_right_hand_side(x);
    SolveLimits own = limits;
    if (links) own.tolerance *= links->add_held(step.right_hand_side());
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
    return step.solve(x, own, job);
}

}  // namespace gischt
