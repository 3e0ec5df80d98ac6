// SPDX-License-Identifier: Apache-2.0
#include "optics/light_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

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

// Cells at the same number of steps from the light, a rectangle of them in a plane across the
// dominant axis: none depends on another.
struct Front {
    int axis = 0, plane = 0;
    double steps = 0;  // to the light; infinite for a direction
    int to_light = 1;  // sign of the way to the light along the axis
    Box3i cells;
};

// A sweep from the light on: the depth of a cell from the bilinear mean of those before it. Around
// a point it is the mean extinction on the way to the light that is interpolated, not the depth,
// which is a cone where the medium is even.
class Sweep {
  public:
    Sweep(const ExtinctionGrid& grid, const LightOrigin& light)
        : grid_(grid),
          light_(light),
          size_(grid.cell_size()),
          depth_(grid.extinction.size()),
          stride_{1, static_cast<std::size_t>(grid.cells.x),
                  static_cast<std::size_t>(grid.cells.x) * static_cast<std::size_t>(grid.cells.y)} {
    }

    std::vector<float> operator()(Job& job) {
        for (const Front& front : light_.is_infinite ? planes() : shells()) {
            job.check();
            const int u = front.axis == 0 ? 1 : 0, v = front.axis == 2 ? 1 : 2;
            parallel_ranges(front.cells.size()[v], 8, [&](int begin, int end) {
                for (int j = begin; j < end; ++j) {
                    sweep_row(front, u, v, front.cells.lo[v] + j);
                }
            });
        }
        if (!light_.is_infinite) {
            parallel_for(grid_.cells.y * grid_.cells.z, 8, [&](int row) {
                Vec3i c(0, row % grid_.cells.y, row / grid_.cells.y);
                for (; c.x < grid_.cells.x; ++c.x) {
                    const Vec3d way = light_.place - grid_.center(c);
                    depth_[grid_.index(c)] *= static_cast<float>(length(way));
                }
            });
        }
        return std::move(depth_);
    }

  private:
    // Planes across the dominant axis of the direction.
    std::vector<Front> planes() {
        const Vec3d d = light_.place / size_;
        const Vec3d length = abs(d);
        const int axis = length.x >= length.y && length.x >= length.z ? 0
                         : length.y >= length.z                       ? 1
                                                                      : 2;
        slope_ = d / length[axis];
        std::vector<Front> fronts;
        for (int p = 0; p < grid_.cells[axis]; ++p) {
            Front f;
            f.axis = axis;
            f.to_light = d[axis] > 0 ? 1 : -1;
            f.plane = f.to_light > 0 ? grid_.cells[axis] - 1 - p : p;
            f.steps = std::numeric_limits<double>::infinity();
            f.cells = {{}, grid_.cells};
            fronts.push_back(f);
        }
        return fronts;
    }

    // Around a point the cells of one number of steps form the faces of a box. A cell takes its
    // depth from cells of fewer steps, so the faces are done in that order.
    std::vector<Front> shells() const {
        const Vec3d at = (light_.place - grid_.box.lo) / size_ - Vec3d(0.5);
        std::vector<Front> fronts;
        for (int axis = 0; axis < 3; ++axis) {
            for (int p = 0; p < grid_.cells[axis]; ++p) {
                Front f;
                f.axis = axis;
                f.plane = p;
                f.steps = std::abs(at[axis] - p);
                f.to_light = at[axis] > p ? 1 : -1;
                // Cells at an edge belong to both faces, whatever the rounding.
                const Vec3d reach(f.steps * (1 + 1e-12) + 1e-12);
                f.cells.lo = max(Vec3i(0), Vec3i(0) - floor(min(reach - at, Vec3d(1e9))));
                f.cells.hi =
                    min(grid_.cells, floor(max(min(at + reach, Vec3d(1e9)), Vec3d(-1))) + Vec3i(1));
                f.cells.lo[axis] = p;
                f.cells.hi[axis] = p + 1;
                if (!f.cells.is_empty()) fronts.push_back(f);
            }
        }
        std::sort(fronts.begin(), fronts.end(), [](const Front& a, const Front& b) {
            return std::tie(a.steps, a.axis, a.plane) < std::tie(b.steps, b.axis, b.plane);
        });
        return fronts;
    }

    // Where the rays from a row of cells cross the plane before, along one axis.
    struct Before {
        double at = 0, slope = 0;
        int low = 0;
        float fraction = 0;
    };
    Before before(const Front& front, int axis, int i) const {
        Before b;
        if (light_.is_infinite) {
            b.slope = slope_[axis];
        } else if (front.steps > 0) {
            b.slope =
                ((light_.place[axis] - grid_.box.lo[axis]) / size_[axis] - 0.5 - i) / front.steps;
        }
        b.at = i + b.slope;
        b.low = static_cast<int>(std::floor(b.at));
        b.fraction = static_cast<float>(b.at - b.low);
        return b;
    }

    void sweep_row(const Front& front, int u, int v, int j) {
        const auto su = stride_[static_cast<std::size_t>(u)],
                   sv = stride_[static_cast<std::size_t>(v)],
                   sa = stride_[static_cast<std::size_t>(front.axis)];
        const int plane = front.plane + front.to_light;
        const bool has_before = plane >= 0 && plane < grid_.cells[front.axis];
        const Before across = before(front, v, j);
        const std::size_t row = static_cast<std::size_t>(j) * sv;
        const std::size_t here = row + static_cast<std::size_t>(front.plane) * sa;
        const double along = size_[front.axis] * size_[front.axis] +
                             across.slope * across.slope * size_[v] * size_[v];
        // Weights of the two rows before, none where they lie outside.
        std::size_t rows[2] = {0, 0};
        float row_weight[2] = {0, 0};
        for (int r = 0; r < 2 && has_before; ++r) {
            const int at = across.low + r;
            if (at < 0 || at >= grid_.cells[v]) continue;
            rows[r] = static_cast<std::size_t>(at) * sv + static_cast<std::size_t>(plane) * sa;
            row_weight[r] = r ? across.fraction : 1 - across.fraction;
        }
        for (int i = front.cells.lo[u]; i < front.cells.hi[u]; ++i) {
            const Before b = before(front, u, i);
            const auto step =
                static_cast<float>(std::sqrt(along + b.slope * b.slope * size_[u] * size_[u]));
            const std::size_t x = here + static_cast<std::size_t>(i) * su;
            const float own = grid_.extinction[x];
            if (front.steps < 1) {
                depth_[x] = own;
                continue;
            }
            float before_sum = 0, extinction = 0;
            for (int c = 0; c < 2; ++c) {
                const int at = b.low + c;
                if (at < 0 || at >= grid_.cells[u]) continue;
                const std::size_t column = static_cast<std::size_t>(at) * su;
                const float weight = c ? b.fraction : 1 - b.fraction;
                for (int r = 0; r < 2; ++r) {
                    const float w = weight * row_weight[r];
                    if (w == 0) continue;
                    const std::size_t y = rows[r] + column;
                    before_sum += w * depth_[y];
                    extinction += w * grid_.extinction[y];
                }
            }
            const float crossed = 0.5f * step * (extinction + own);
            const auto steps = static_cast<float>(front.steps);
            depth_[x] = light_.is_infinite
                            ? before_sum + crossed
                            : (before_sum * step * (steps - 1) + crossed) / (step * steps);
        }
    }

    const ExtinctionGrid& grid_;
    const LightOrigin& light_;
    Vec3d size_;
    Vec3d slope_;               // of a direction
    std::vector<float> depth_;  // of a point while it is swept: divided by the distance
    std::array<std::size_t, 3> stride_;
};

// Adds `sign` times the depth of the half of each cell that lies towards the light.
void add_half_cells(const ExtinctionGrid& grid, const Tracer& tracer, float sign,
                    std::vector<float>& depth) {
    parallel_for(grid.cells.y * grid.cells.z, 8, [&](int row) {
        Vec3i c(0, row % grid.cells.y, row / grid.cells.y);
        for (; c.x < grid.cells.x; ++c.x) {
            const float own = tracer.extinction(c);
            if (own == 0) continue;
            const Way w = tracer.way(c);
            const auto half = static_cast<float>(std::min(0.5, w.steps));
            float& d = depth[grid.index(c)];
            d = std::max(0.0f, d + sign * half * w.step_length * own);
        }
    });
}

// Along a line from each cell, up to its entry.
std::vector<float> traced_depths(const ExtinctionGrid& grid, const Tracer& tracer, bool is_exact,
                                 Job& job) {
    std::vector<float> depth(grid.extinction.size());
    parallel_for(static_cast<int>(depth.size()), 256, [&](int i) {
        if (i % 4096 == 0) job.check();
        const Vec3i c = cell_of(grid, static_cast<std::size_t>(i));
        depth[static_cast<std::size_t>(i)] = is_exact ? tracer.exact(c) : tracer.bresenham(c);
    });
    return depth;
}

}  // namespace

float LightGrid::shade(const ExtinctionGrid& grid, const LightOrigin& light, const Vec3i& cell,
                       float albedo, float radiance) const {
    // The ray through the centre crosses the cell in one step's length.
    const Tracer tracer(grid, light);
    const float inside = tracer.extinction(cell) * tracer.way(cell).step_length;
    return albedo * radiance * (1 - std::exp(-inside)) * transmittance[grid.index(cell)];
}

std::vector<float> depths_to_centers(const ExtinctionGrid& grid, const LightOrigin& light,
                                     LightGridMethod method, Job& job) {
    if (method == LightGridMethod::Sweep) return Sweep(grid, light)(job);
    const Tracer tracer(grid, light);
    std::vector<float> depth = traced_depths(grid, tracer, method == LightGridMethod::Exact, job);
    add_half_cells(grid, tracer, 1, depth);
    return depth;
}

LightGrid light_to_cells(const ExtinctionGrid& grid, const LightOrigin& light,
                         LightGridMethod method, Job& job) {
    const Tracer tracer(grid, light);
    LightGrid out;
    if (method == LightGridMethod::Sweep) {
        out.transmittance = Sweep(grid, light)(job);
        add_half_cells(grid, tracer, -1, out.transmittance);
    } else {
        out.transmittance = traced_depths(grid, tracer, method == LightGridMethod::Exact, job);
    }
    parallel_ranges(static_cast<int>(out.transmittance.size()), 4096, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            float& t = out.transmittance[static_cast<std::size_t>(i)];
            t = std::exp(-t);
        }
    });
    return out;
}

}  // namespace gischt
