// SPDX-License-Identifier: Apache-2.0
#include "render/march/light_nodes.h"

#include <algorithm>

#include "base/parallel.h"
#include "optics/medium_depth.h"

namespace gischt {

LightNodes::LightNodes(const Medium& medium, double spacing) {
    const Medium::Lattice lattice = medium.lattice();
    if (!(lattice.box.lo.x < lattice.box.hi.x)) return;
    const Vec3d lo(floor(lattice.box.lo / Vec3d(spacing)));
    n = -1 * floor(-1.0 * (lattice.box.hi / Vec3d(spacing) - lo)) + Vec3i(1);
    to_world = lattice.to_world * Transform::scale_translate(spacing, {}) *
               Transform::scale_translate(1, lo);
    is_needed.assign(volume(n), 0);
}

void LightNodes::add(const Medium& medium, bool is_target) {
    const Vec3f strength = medium.cross_sections().extinction();
    parallel_for(n.z, 1, [&](int k) {
        std::vector<float> line(2 * static_cast<std::size_t>(n.x)),
            row(static_cast<std::size_t>(n.x));
        for (int j = 0; j < n.y; ++j) {
            std::fill(row.begin(), row.end(), 0.0f);
            for (int s = 0; s < 4; ++s) {
                const Vec3d start(-0.25, j + (s % 2 ? 0.25 : -0.25), k + (s / 2 ? 0.25 : -0.25));
                densities_on_line(medium, {to_world.point(start), to_world.column[0]}, 0, 0.5,
                                  line);
                for (std::size_t i = 0; i < row.size(); ++i) {
                    row[i] += 0.125f * (line[2 * i] + line[2 * i + 1]);
                }
            }
            const std::size_t first = index(0, j, k);
            for (std::size_t c = 0; c < extinction.size(); ++c) {
                for (std::size_t i = 0; i < row.size(); ++i) {
                    extinction[c][first + i] += row[i] * strength[static_cast<int>(c)];
                }
            }
            for (std::size_t i = 0; is_target && i < row.size(); ++i) {
                if (row[i] > 0) is_needed[first + i] = 1;
            }
        }
    });
}

void LightNodes::widen_needed() {
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<std::uint8_t> before = is_needed;
        const std::size_t step = axis == 0   ? 1
                                 : axis == 1 ? static_cast<std::size_t>(n.x)
                                             : index(0, 0, 1);
        parallel_for(n.z, 1, [&](int k) {
            for (int j = 0; j < n.y; ++j) {
                for (int i = 0; i < n.x; ++i) {
                    const int at = axis == 0 ? i : axis == 1 ? j : k;
                    const std::size_t x = index(i, j, k);
                    if ((at > 0 && before[x - step]) || (at + 1 < n[axis] && before[x + step])) {
                        is_needed[x] = 1;
                    }
                }
            }
        });
    }
}

void LightNodes::find_opaque(const SurfaceSet& surfaces) {
    if (surfaces.is_empty()) return;
    is_opaque.assign(is_needed.size(), 0);
    parallel_for(n.z, 1, [&](int k) {
        for (int j = 0; j < n.y; ++j) {
            for (int i = 0; i < n.x; ++i) {
                const Vec3d center(i, j, k);
                bool is_hit = false;
                for (std::size_t a = 0; a < 3 && !is_hit; ++a) {
                    const Vec3d d = to_world.column[a];
                    is_hit = surfaces.is_blocked({to_world.point(center) - 0.5 * d, d, 0, 1});
                }
                is_opaque[index(i, j, k)] = is_hit;
            }
        }
    });
}

}  // namespace gischt
