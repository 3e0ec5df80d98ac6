// SPDX-License-Identifier: Apache-2.0
#include "render/march/sky_grid.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/interpolate.h"
#include "render/march/light_nodes.h"
#include "render/march/march_scene.h"
#include "render/march/sky_sweep.h"

namespace gischt {
namespace {

SweepGrid sweep_grid(const LightNodes& nodes, int axis) {
    SweepGrid g;
    g.axis = axis;
    g.u = axis == 0 ? 1 : 0;
    g.v = axis == 2 ? 1 : 2;
    g.nu = nodes.n[g.u];
    g.nv = nodes.n[g.v];
    g.planes = nodes.n[axis];
    g.to_world = nodes.to_world;
    for (const auto& e : nodes.extinction) g.extinction.emplace_back(e.size());
    g.is_opaque.resize(nodes.is_opaque.size());
    g.needed.resize(g.row(0, g.planes));
    parallel_for(g.planes, 1, [&](int p) {
        for (int v = 0; v < g.nv; ++v) {
            SweepGrid::Range& range = g.needed[g.row(v, p)];
            range = {g.nu, 0};
            for (int u = 0; u < g.nu; ++u) {
                Vec3i c;
                c[g.axis] = p;
                c[g.u] = u;
                c[g.v] = v;
                const std::size_t from = nodes.index(c.x, c.y, c.z);
                const std::size_t to =
                    g.row(v, p) * static_cast<std::size_t>(g.nu) + static_cast<std::size_t>(u);
                for (std::size_t e = 0; e < g.extinction.size(); ++e) {
                    g.extinction[e][to] = nodes.extinction[e][from];
                }
                if (!g.is_opaque.empty()) g.is_opaque[to] = nodes.is_opaque[from];
                if (nodes.is_needed[from]) {
                    range.begin = std::min(range.begin, u);
                    range.end = u + 1;
                }
            }
        }
    });
    return g;
}

// Directions in which the camera sees the medium: the corners of its box and its middle.
std::vector<Vec3d> view_directions(const Camera& camera, const Box3d& box) {
    if (camera.projection() == Projection::Orthographic) return {camera.forward()};
    std::vector<Vec3d> out;
    for (int c = 0; c < 9; ++c) {
        const Vec3d p = c == 8 ? 0.5 * (box.lo + box.hi)
                               : Vec3d(c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y,
                                       c & 4 ? box.hi.z : box.lo.z);
        const Vec3d d = p - camera.position();
        if (dot(d, d) > 0) out.push_back(normalize(d));
    }
    return out;
}

// The share of the light from a direction that the other media leave on its way to the box, taken
// where the ray from its middle leaves it.
Vec3f share_outside(const MarchScene& scene, std::size_t index, const Box3d& box,
                    const Vec3d& direction) {
    Ray ray{0.5 * (box.lo + box.hi), direction};
    ray.t_min = clip(ray, box).t1;
    Vec3f depth;
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        if (m == index) continue;
        depth += density_integral(*scene.media[m].medium, ray, scene.shadow_steps()) *
                 scene.media[m].extinction;
    }
    return exp(-depth);
}

}  // namespace

SkyGrid::SkyGrid(const MarchScene& scene, std::size_t index, Job& job) {
    const MarchMedium& target = scene.media[index];
    const Vec3d extent = target.medium->lattice().box.size();
    const double spacing =
        std::max(0.5, std::cbrt(extent.x * extent.y * extent.z / scene.params.sky_nodes));
    LightNodes nodes(*target.medium, spacing);
    n_ = nodes.n;
    to_world_ = nodes.to_world;
    to_lattice_ = to_world_.inverse();
    const std::size_t count = volume(n_);
    if (count == 0) return;
    nodes.extinction.assign(scene.is_grey ? 1 : 3, std::vector<float>(count));
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        nodes.add(*scene.media[m].medium, m == index);
    }
    nodes.widen_needed();
    nodes.find_opaque(scene.view.surfaces);
    job.check();

    const Camera& camera = scene.view.camera;
    const Box3d box = target.medium->bounds();
    std::vector<Vec3d> forward = view_directions(camera, box);
    const std::vector<SkyDirection> sky =
        sky_directions(scene.broad, target.octaves[0].phase, forward, scene.params.sky_directions);

    // Directions by the axis that they are swept along.
    std::vector<SweepGrid> grids;
    std::vector<std::vector<std::size_t>> by_axis(3);
    for (int axis = 0; axis < 3; ++axis) grids.push_back(sweep_grid(nodes, axis));
    for (std::size_t d = 0; d < sky.size(); ++d) {
        const Vec3d c = abs(to_lattice_.vector(sky[d].direction));
        by_axis[c.x >= c.y && c.x >= c.z ? 0 : c.y >= c.z ? 1 : 2].push_back(d);
    }

    // A fixed division of the work: the same sums on any number of threads.
    constexpr std::size_t parts = 4;
    std::vector<SweepSums> sums(3 * parts, SweepSums(0, false));
    parallel_for(static_cast<int>(3 * parts), 1, [&](int task) {
        const auto t = static_cast<std::size_t>(task);
        const std::size_t axis = t / parts, part = t % parts;
        sums[t] = SweepSums(count, target.octaves.size() > 1);
        SkySweep sweep(grids[axis], camera, target.octaves, scene.view.surfaces);
        for (std::size_t i = part; i < by_axis[axis].size(); i += parts) {
            job.check();
            const SkyDirection& d = sky[by_axis[axis][i]];
            sweep.add(d, share_outside(scene, index, box, d.direction), sums[t]);
        }
    });

    light_.resize(count);
    parallel_for(n_.z, 1, [&](int k) {
        for (int j = 0; j < n_.y; ++j) {
            for (int i = 0; i < n_.x; ++i) {
                const Vec3i c(i, j, k);
                std::array<float, 7> sum{};
                for (std::size_t t = 0; t < sums.size(); ++t) {
                    const SweepGrid& g = grids[t / parts];
                    const std::size_t at =
                        g.row(c[g.v], c[g.axis]) * static_cast<std::size_t>(g.nu) +
                        static_cast<std::size_t>(c[g.u]);
                    sum[3] += sums[t].phase[at];
                    for (std::size_t ch = 0; ch < 3; ++ch) {
                        sum[ch] += sums[t].single[ch][at];
                        if (!sums[t].octaves[ch].empty()) sum[4 + ch] += sums[t].octaves[ch][at];
                    }
                }
                // The phase function's integral over the sphere is 1, of which the parts of the
                // sky leave a ripple.
                std::array<float, 4>& out = light_[node(i, j, k)];
                for (std::size_t ch = 0; ch < 3 && sum[3] > 0; ++ch) {
                    out[ch] = sum[ch] / sum[3] + sum[4 + ch];
                }
            }
        }
    });
}

Vec3f SkyGrid::operator()(const Vec3d& point) const {
    if (light_.empty()) return {};
    const Vec3d q = to_lattice_.point(point);
    Vec3i c;
    Vec3f f;
    for (int a = 0; a < 3; ++a) {
        const double x = std::clamp(q[a], 0.0, static_cast<double>(n_[a] - 1));
        c[a] = std::min(static_cast<int>(x), n_[a] - 2);
        f[a] = static_cast<float>(x - c[a]);
    }
    const std::size_t sy = static_cast<std::size_t>(n_.x), sz = node(0, 0, 1);
    const std::array<float, 4>* p = light_.data() + node(c.x, c.y, c.z);
    std::array<float, 4> out;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto edge = [&](std::size_t at) { return lerp(p[at][i], p[at + 1][i], f.x); };
        out[i] = lerp(lerp(edge(0), edge(sy), f.y), lerp(edge(sz), edge(sz + sy), f.y), f.z);
    }
    return {out[0], out[1], out[2]};
}

}  // namespace gischt
