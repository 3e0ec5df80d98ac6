// SPDX-License-Identifier: Apache-2.0
#include "shape/distance_lattice.h"

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace gischt {

DistanceLattice::DistanceLattice(const MeshDistance& mesh, double spacing, double limit)
    : spacing_(spacing), limit_(limit) {
    const Vec3d margin(limit + spacing);
    const Vec3d cells = (mesh.bounds().size() + 2.0 * margin) / spacing;
    if (!(spacing > 0) || !(limit > 0) || !(cells.x * cells.y * cells.z < 1 << 30)) {
        throw Error(ErrorKind::Usage, "mesh",
                    "is too large for cells of " + std::to_string(spacing) + " m",
                    "scale it down, or make the cells larger");
    }
    origin_ = mesh.bounds().lo - margin;
    count_ = floor(cells) + Vec3i(2);
    values_.resize(volume(count_));
    parallel_for(count_.z, 1, [&](int k) {
        std::size_t at = static_cast<std::size_t>(k) * static_cast<std::size_t>(count_.x) *
                         static_cast<std::size_t>(count_.y);
        for (int j = 0; j < count_.y; ++j) {
            for (int i = 0; i < count_.x; ++i, ++at) {
                const Vec3d p = origin_ + spacing_ * Vec3d(i, j, k);
                const double d = mesh.distance(p, limit_);
                values_[at] = static_cast<float>(mesh.is_inside(p) ? -d : d);
            }
        }
    });
}

double DistanceLattice::at(const Vec3d& p) const {
    const Vec3d q = (p - origin_) / spacing_;
    Vec3i low;
    Vec3d part;
    for (int a = 0; a < 3; ++a) {
        if (!(q[a] >= 0) || q[a] >= count_[a] - 1) return limit_;
        low[a] = static_cast<int>(q[a]);
        part[a] = q[a] - low[a];
    }
    const auto row = [&](int j, int k) {
        const auto at =
            static_cast<std::size_t>(low.x) +
            static_cast<std::size_t>(count_.x) *
                (static_cast<std::size_t>(low.y + j) +
                 static_cast<std::size_t>(count_.y) * static_cast<std::size_t>(low.z + k));
        return std::lerp(static_cast<double>(values_[at]), static_cast<double>(values_[at + 1]),
                         part.x);
    };
    return std::lerp(std::lerp(row(0, 0), row(1, 0), part.y),
                     std::lerp(row(0, 1), row(1, 1), part.y), part.z);
}

}  // namespace gischt
