// SPDX-License-Identifier: Apache-2.0
#include "render/march/point_depth.h"

#include <algorithm>

#include "base/parallel.h"
#include "math/interpolate.h"
#include "render/march/light_nodes.h"

namespace gischt {

PointDepth::PointDepth(const Medium& medium, const Vec3d& light, double spacing,
                       const DepthSteps& steps, Job& job) {
    LightNodes nodes(medium, spacing);
    n_ = nodes.n;
    to_lattice_ = nodes.to_world.inverse();
    nodes.add(medium, true);
    nodes.widen_needed();
    depth_.assign(nodes.is_needed.size(), 0.0f);
    parallel_for(n_.y * n_.z, 4, [&](int row) {
        job.check();
        const int j = row % n_.y, k = row / n_.y;
        for (int i = 0; i < n_.x; ++i) {
            const std::size_t at = nodes.index(i, j, k);
            if (!nodes.is_needed[at]) continue;
            const Vec3d point = nodes.to_world.point(Vec3d(i, j, k));
            depth_[at] = density_integral(medium, {point, light - point, 0, 1}, steps);
        }
    });
}

float PointDepth::operator()(const Vec3d& point) const {
    const Vec3d q = to_lattice_.point(point);
    Vec3i c;
    Vec3f f;
    for (int a = 0; a < 3; ++a) {
        const double x = std::clamp(q[a], 0.0, static_cast<double>(n_[a] - 1));
        c[a] = std::min(static_cast<int>(x), n_[a] - 2);
        f[a] = static_cast<float>(x - c[a]);
    }
    const std::size_t sy = static_cast<std::size_t>(n_.x), sz = sy * static_cast<std::size_t>(n_.y);
    const float* p = depth_.data() + static_cast<std::size_t>(c.x) +
                     sy * static_cast<std::size_t>(c.y) + sz * static_cast<std::size_t>(c.z);
    const auto edge = [&](std::size_t at) { return lerp(p[at], p[at + 1], f.x); };
    return lerp(lerp(edge(0), edge(sy), f.y), lerp(edge(sz), edge(sz + sy), f.y), f.z);
}

}  // namespace gischt
