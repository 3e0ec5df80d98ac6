// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "solve/diffusion_step.h"
#include "solve/stencil_build.h"
#include "solve/surface_links.h"

namespace gischt {
namespace {

bool is_wall(Border b) {
    return b == Border::Even || b == Border::Odd || b == Border::Zero;
}

// The faces of one component that are unknown, as cells of a box of their own: cell c is face c +
// offset. Along the component's axis the faces on walls are known, beyond open sides nothing is.
struct Unknowns {
    int axis;
    Vec3i offset, count;
    SideRules sides;
    Borders borders;  // how known values and solids continue: Periodic or Clamp

    Unknowns(const FaceField& u, int component, const VelocitySides& v) : axis(component) {
        count = u.map().bounds().size();
        for (int a = 0; a < 3; ++a) {
            for (int end = 0; end < 2; ++end) {
                const Border b = v.rule(a, end);
                const auto s = static_cast<std::size_t>(2 * a + end);
                const bool wraps = b == Border::Periodic;
                borders.side[s] = wraps ? Border::Periodic : Border::Clamp;
                SideRule& side = sides[s];
                if (wraps) {
                    side.kind = SideRule::Kind::Periodic;
                } else if (a == axis && is_wall(b)) {
                    side = {SideRule::Kind::Fixed, 1.0};
                    if (end == 0) offset[a] = 1, count[a] -= 1;
                } else if (a != axis && (b == Border::Odd || b == Border::Zero)) {
                    side = {SideRule::Kind::Fixed, b == Border::Odd ? 0.5 : 1.0};
                }
                if (a == axis && end == 1 && b == Border::Clamp) count[a] += 1;
            }
        }
    }
    bool is_none() const { return min_component(count) < 1; }
    // The faces of a tile of the box, `halo` more on each side.
    Box3i faces_of(const TileMap& map, int tile, int halo) const {
        Box3i box = map.cells_of(tile);
        Vec3i h(halo);
        if (map.is_2d()) h.z = 0;
        return {box.lo + offset - h, box.hi + offset + h};
    }
};

// Calls f(cell, index) for the cells of a tile inside the box.
template <class F>
void for_cells(const TileMap& map, int tile, F&& f) {
    const Box3i cells = map.cells_of(tile);
    for (int k = cells.lo.z; k < cells.hi.z; ++k) {
        for (int j = cells.lo.y; j < cells.hi.y; ++j) {
            for (int i = cells.lo.x; i < cells.hi.x; ++i) {
                const Vec3i local = Vec3i(i, j, k) - map.first_cell(tile);
                f(Vec3i(i, j, k), map.shape().index(local.x, local.y, local.z));
            }
        }
    }
}

TileField<float> load(const FaceField& u, const Unknowns& un, const TileMap::Ptr& map) {
    TileField<float> x(map);
    parallel_for(map->size(), 16, [&](int t) {
        const Box3i faces = un.faces_of(*map, t, 0);
        float values[tile_values];
        gather_faces(u, un.axis, faces, un.borders, values);
        int at = 0;
        for_cells(*map, t, [&](const Vec3i&, int v) { x.tile(t)[v] = values[at++]; });
    });
    return x;
}

void store(const TileField<float>& x, const Unknowns& un, FaceField& u) {
    TileField<float>& component = u[un.axis];
    const TileMap& map = u.map();
    const Box3i known{un.offset, un.offset + un.count};
    parallel_for(map.size(), 16, [&](int t) {
        const Box3i faces = intersection(map.cells_of(t), known);
        if (faces.is_empty()) return;
        float values[tile_values];
        gather(x, {faces.lo - un.offset, faces.hi - un.offset}, un.borders, values);
        int at = 0;
        for_cells(map, t, [&](const Vec3i& face, int v) {
            if (known.contains(face)) component.tile(t)[v] = values[at++];
        });
    });
    // The last faces are unknown at an open side and copies of the first at a periodic one.
    const int n = map.bounds().hi[un.axis];
    const bool wraps = un.borders(un.axis, 1) == Border::Periodic;
    if (!wraps && un.offset[un.axis] + un.count[un.axis] <= n) return;
    Box3i plane = map.bounds();
    plane.lo[un.axis] = n;
    plane.hi[un.axis] = n + 1;
    for (int k = plane.lo.z; k < plane.hi.z; ++k) {
        for (int j = plane.lo.y; j < plane.hi.y; ++j) {
            for (int i = plane.lo.x; i < plane.hi.x; ++i) {
                Vec3i from = Vec3i(i, j, k) - un.offset;
                if (wraps) from[un.axis] = 0;
                u.ref(un.axis, {i, j, k}) = x.get(from);
            }
        }
    }
}

// Faces in solids, and what they hold.
SurfaceLinks links_of(const VelocitySolids& solids, const Unknowns& un, const TileMap::Ptr& map) {
    const bool sticks = solids.distance != nullptr;
    const FaceField& distance = sticks ? *solids.distance : *solids.fraction;
    SurfaceLinks links(map, un.borders, sticks);
    parallel_for(map->size(), 16, [&](int t) {
        const Box3i faces = un.faces_of(*map, t, 1);
        TileSurroundings around{{faces.lo - un.offset, faces.hi - un.offset}, {}, {}};
        around.distance.resize(volume(faces.size()));
        gather_faces(distance, un.axis, faces, un.borders, around.distance.data());
        if (around.is_open()) return;
        if (solids.wall != nullptr) {
            around.value.resize(around.distance.size());
            gather_faces(*solids.wall, un.axis, faces, un.borders, around.value.data());
        }
        links.link(t, around);
    });
    return links;
}

// What the walls hold beyond the unknowns: along the own axis the face on the wall, else the wall's
// velocity. Not for faces inside solids, which stay as they are.
void add_walls(const FaceField& u, const VelocitySides& sides, const VelocitySolids& solids,
               const Unknowns& un, DiffusionStep& step) {
    const FaceField* open = solids.distance != nullptr ? solids.distance : solids.fraction;
    for (int a = 0; a < u.axes(); ++a) {
        for (int end = 0; end < 2; ++end) {
            step.add_side(a, end, [&](const Vec3i& cell) {
                Vec3i face = cell + un.offset;
                if (open != nullptr && !(open->get(un.axis, face) > 0)) return 0.0f;
                if (a != un.axis) {
                    return sides.velocity[static_cast<std::size_t>(2 * a + end)][un.axis];
                }
                face[a] += end == 0 ? -1 : 1;
                return u.get(un.axis, face);
            });
        }
    }
}

SolveResult diffuse_component(FaceField& u, double number, const VelocitySides& sides,
                              const VelocitySolids& solids, int axis, const SolveLimits& limits,
                              Job& job) {
    const Unknowns un(u, axis, sides);
    if (un.is_none()) return {0, 0, true};
    StencilSpec spec;
    spec.map = full_map(un.count, u.map().shape());
    spec.sides = un.sides;
    std::optional<SurfaceLinks> links;
    if (solids.fraction != nullptr || solids.distance != nullptr) {
        links.emplace(links_of(solids, un, spec.map));
        spec.fraction = &links->weight;
        spec.extra = &links->extra;
    }
    DiffusionStep step(spec, number);
    if (step.is_identity()) return {0, 0, true};

    TileField<float> x = load(u, un, spec.map);
    step.set_right_hand_side(x);
    SolveLimits own = limits;
    if (links) own.tolerance *= links->add_held(step.right_hand_side());
    add_walls(u, sides, solids, un, step);
    const SolveResult result = step.solve(x, own, job);
    store(x, un, u);
    return result;
}

}  // namespace

SolveResult diffuse(FaceField& u, double number, const VelocitySides& sides,
                    const VelocitySolids& solids, const SolveLimits& limits, Job& job) {
    SolveResult worst{0, 0, true};
    for (int a = 0; a < u.axes(); ++a) {
        const SolveResult r = diffuse_component(u, number, sides, solids, a, limits, job);
        worst.iterations = std::max(worst.iterations, r.iterations);
        worst.residual = std::max(worst.residual, r.residual);
        worst.converged = worst.converged && r.converged;
    }
    return worst;
}

}  // namespace gischt
