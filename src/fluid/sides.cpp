// SPDX-License-Identifier: Apache-2.0
#include "fluid/sides.h"

#include "fluid/block.h"

namespace gischt {

void close_sides(const Domain& domain, FaceField& velocity) {
    for (int a = 0; a < domain.axes(); ++a) {
        Box3i faces{{}, domain.cells};
        faces.hi[a] = 1;
        auto& last = velocity.last[static_cast<std::size_t>(a)];
        const auto is_wall = [&](int end) {
            const SideKind s = domain.side_of(a, end);
            return s == SideKind::FreeSlip || s == SideKind::NoSlip;
        };
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

}  // namespace gischt
