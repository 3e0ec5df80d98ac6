// SPDX-License-Identifier: Apache-2.0
#include "fluid/sides.h"

#include "fluid/block.h"

namespace gischt {
namespace {

void let_in(const Domain& domain, int axis, int end, FaceField& velocity) {
    Box3i faces{{}, domain.cells};
    faces.lo[axis] = end == 0 ? 0 : domain.cells[axis];
    faces.hi[axis] = faces.lo[axis] + 1;
    for_cells(faces, [&](const Vec3i& face) {
        velocity.ref(axis, face) = inflow_velocity(domain, axis, end, face);
    });
}

}  // namespace

void close_sides(const Domain& domain, FaceField& velocity) {
    for (int a = 0; a < domain.axes(); ++a) {
        Box3i faces{{}, domain.cells};
        faces.hi[a] = 1;
        auto& last = velocity.last[static_cast<std::size_t>(a)];
        const auto is_wall = [&](int end) {
            const SideKind s = domain.side_of(a, end);
            return s == SideKind::FreeSlip || s == SideKind::NoSlip;
        };
        for (const int end : {0, 1}) {
            if (domain.side_of(a, end) == SideKind::Inflow) let_in(domain, a, end, velocity);
        }
        if (is_wall(1)) std::fill(last.begin(), last.end(), 0.0f);
        if (!is_wall(0) && !domain.is_periodic(a)) continue;
        for_cells(faces, [&](const Vec3i& face) {
            if (is_wall(0)) {
                velocity[a].ref(face) = 0;
            } else {
                last[velocity.last_index(a, face)] = velocity[a].get(face);
            }
        });
    }
}

void slow_inflow(const Domain& domain, double dt, FaceField& velocity) {
    const auto factor = static_cast<float>(0.5 * dt / domain.h);
    for (int a = 0; a < domain.axes(); ++a) {
        for (int end = 0; end < 2; ++end) {
            if (domain.side_of(a, end) != SideKind::Open) continue;
            Box3i faces{{}, domain.cells};
            faces.lo[a] = end == 0 ? 0 : domain.cells[a];
            faces.hi[a] = faces.lo[a] + 1;
            for_cells(faces, [&](const Vec3i& face) {
                float& u = velocity.ref(a, face);
                const float inwards = end == 0 ? u : -u;
                if (inwards > 0) u /= 1 + factor * inwards;
            });
        }
    }
}

void activate_sides(const Domain& domain, const BlockMap& blocks, const ScalarHold& hold,
                    SparseField& field) {
    if (hold.is_plain) return;
    for (int b = 0; b < blocks.size(); ++b) {
        const Box3i cells = blocks.cells(b);
        for (int a = 0; a < domain.axes(); ++a) {
            const auto s = static_cast<std::size_t>(2 * a);
            const bool low = cells.lo[a] == 0 && hold.value[s] != 0,
                       high = cells.hi[a] == domain.cells[a] && hold.value[s + 1] != 0;
            if (low || high) field.active[static_cast<std::size_t>(b)] = 1;
        }
    }
}

}  // namespace gischt
