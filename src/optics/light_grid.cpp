// SPDX-License-Identifier: Apache-2.0
#include "optics/light_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"

namespace gischt {
namespace {

// The way from the centre of a cell to the light, in cells.
struct Way {
    Vec3d cells;        // the whole of it for a point light, else a direction
    double steps;       // of one cell along the dominant axis; infinite for a direction
    Vec3d slope;        // cells per step; one component is +-1
    float step_length;  // metres
};

class Tracer {
  public:
    Tracer(const ExtinctionGrid& grid, const LightOrigin& light)
        : grid_(grid), light_(light), size_(grid.cell_size()) {}

    Way way(const Vec3i& cell) const {
        const Vec3d d =
            (light_.is_infinite ? light_.place : light_.place - grid_.center(cell)) / size_;
        const double longest = max_component(abs(d));
        const Vec3d slope = longest > 0 ? d / longest : Vec3d(0, 0, 1);
        return {d, light_.is_infinite ? std::numeric_limits<double>::infinity() : longest, slope,
                static_cast<float>(length(slope * size_))};
    }

    bool is_inside(const Vec3i& c) const {
        return min_component(c) >= 0 && c.x < grid_.cells.x && c.y < grid_.cells.y &&
               c.z < grid_.cells.z;
    }
    float extinction(const Vec3i& c) const { return grid_.extinction[grid_.index(c)]; }

    // Optical depth of the voxels between a cell and the light, with exact lengths: from face to
    // face (Amanatides & Woo 1987).
    float exact(const Vec3i& cell) const {
        const Way w = way(cell);
        Vec3i at = cell;
        Vec3d next;  // where the ray leaves the voxel by each axis, in steps
        Vec3i sign;
        for (int a = 0; a < 3; ++a) {
            sign[a] = w.slope[a] > 0 ? 1 : -1;
            next[a] = w.slope[a] != 0 ? 0.5 / std::abs(w.slope[a])
                                      : std::numeric_limits<double>::infinity();
        }
        double from = min_component(next), depth = 0;
        while (from < w.steps) {
            const int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
            at[axis] += sign[axis];
            next[axis] += 1 / std::abs(w.slope[axis]);
            if (!is_inside(at)) {
                // From outside a ray away from the grid does not come back.
                break;
            }
            const double to = std::min(min_component(next), w.steps);
            depth += static_cast<double>(extinction(at)) * (to - from);
            from = to;
        }
        return static_cast<float>(depth * static_cast<double>(w.step_length));
    }

    // The same by a Bresenham line in three dimensions: one voxel per step of the dominant axis.
    float bresenham(const Vec3i& cell) const {
        const Way w = way(cell);
        float sum = 0;
        for (int k = 1; k < w.steps + 0.5; ++k) {
            const Vec3i at = cell + floor(static_cast<double>(k) * w.slope + Vec3d(0.5));
            if (!is_inside(at)) break;
            sum += extinction(at);
        }
        return sum * w.step_length;
    }

    // Depth up to the centre of a cell from those of the cells before it.
    float swept(const Vec3i& cell, const std::vector<float>& depth) const {
        const Way w = way(cell);
        const float own = extinction(cell);
        if (w.steps < 1) return own * w.step_length * static_cast<float>(w.steps);
        const Vec3d q = Vec3d(cell) + w.slope;
        const Vec3i lo = floor(q);
        const Vec3d f = q - Vec3d(lo);
        float sum = 0;
        for (int c = 0; c < 8; ++c) {
            const double weight =
                (c & 1 ? f.x : 1 - f.x) * (c & 2 ? f.y : 1 - f.y) * (c & 4 ? f.z : 1 - f.z);
            const Vec3i at = lo + Vec3i(c & 1, c >> 1 & 1, c >> 2);
            if (weight <= 0 || !is_inside(at)) continue;
            sum += static_cast<float>(weight) *
                   (depth[grid_.index(at)] + 0.5f * w.step_length * extinction(at));
        }
        return sum + 0.5f * w.step_length * own;
    }

  private:
    const ExtinctionGrid& grid_;
    const LightOrigin& light_;
    Vec3d size_;
};

Vec3i cell_of(const ExtinctionGrid& grid, std::size_t index) {
    const auto i = static_cast<int>(index);
    const Vec3i n = grid.cells;
    return {i % n.x, i / n.x % n.y, i / n.x / n.y};
}

// Planes across the dominant axis, from the light on: each depends on the one before.
void sweep_planes(const ExtinctionGrid& grid, const Tracer& tracer, std::vector<float>& depth,
                  Job& job) {
    const Vec3d slope = tracer.way({}).slope;
    const int axis = std::abs(slope.x) == 1 ? 0 : std::abs(slope.y) == 1 ? 1 : 2;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3, planes = grid.cells[axis];
    for (int p = 0; p < planes; ++p) {
        job.check();
        parallel_for(grid.cells[v], 4, [&](int j) {
            Vec3i c;
            c[axis] = slope[axis] > 0 ? planes - 1 - p : p;
            c[v] = j;
            for (c[u] = 0; c[u] < grid.cells[u]; ++c[u]) {
                depth[grid.index(c)] = tracer.swept(c, depth);
            }
        });
    }
}

// Cells in the order of the number of steps to the light: those that a cell is computed from are
// nearer by that measure.
void sweep_shells(const ExtinctionGrid& grid, const Tracer& tracer, std::vector<float>& depth,
                  Job& job) {
    std::vector<float> steps(depth.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i] = static_cast<float>(tracer.way(cell_of(grid, i)).steps);
    }
    job.check();
    std::vector<std::size_t> order(depth.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return steps[a] != steps[b] ? steps[a] < steps[b] : a < b;
    });
    job.check();
    for (const std::size_t i : order) depth[i] = tracer.swept(cell_of(grid, i), depth);
}

}  // namespace

float LightGrid::shade(const ExtinctionGrid& grid, const LightOrigin& light, const Vec3i& cell,
                       float albedo, float radiance) const {
    // The ray through the centre crosses the cell in one step's length.
    const Tracer tracer(grid, light);
    const float inside = tracer.extinction(cell) * tracer.way(cell).step_length;
    return albedo * radiance * (1 - std::exp(-inside)) * transmittance[grid.index(cell)];
}

LightGrid light_to_cells(const ExtinctionGrid& grid, const LightOrigin& light,
                         LightGridMethod method, Job& job) {
    const Tracer tracer(grid, light);
    std::vector<float> depth(grid.extinction.size());
    if (method == LightGridMethod::Sweep) {
        (light.is_infinite ? sweep_planes : sweep_shells)(grid, tracer, depth, job);
        // From the centres back to the entries.
        for (std::size_t i = 0; i < depth.size(); ++i) {
            const Vec3i c = cell_of(grid, i);
            const Way w = tracer.way(c);
            const auto half = static_cast<float>(std::min(0.5, w.steps));
            depth[i] = std::max(0.0f, depth[i] - half * w.step_length * tracer.extinction(c));
        }
    } else {
        const bool is_exact = method == LightGridMethod::Exact;
        parallel_for(static_cast<int>(depth.size()), 256, [&](int i) {
            if (i % 4096 == 0) job.check();
            const Vec3i c = cell_of(grid, static_cast<std::size_t>(i));
            depth[static_cast<std::size_t>(i)] = is_exact ? tracer.exact(c) : tracer.bresenham(c);
        });
    }
    LightGrid out;
    out.transmittance.resize(depth.size());
    for (std::size_t i = 0; i < depth.size(); ++i) out.transmittance[i] = std::exp(-depth[i]);
    return out;
}

}  // namespace gischt
