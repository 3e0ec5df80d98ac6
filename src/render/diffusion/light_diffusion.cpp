// SPDX-License-Identifier: Apache-2.0
#include "render/diffusion/light_diffusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "solve/stencil_solver.h"

namespace gischt {
namespace {

constexpr double least_thickness = 1e-3;  // of a cell in free paths
constexpr int most_iterations = 200;
constexpr double extrapolation = 0.7104;  // free paths: Milne's problem (Hopf 1934)

// One channel of the problem on cells of edge h; everything is divided by h and by the largest D.
class Channel {
  public:
    Channel(const DiffusionProblem& problem, int channel)
        : problem_(problem),
          grid_(problem.grid),
          channel_(channel),
          h_(grid_.cell_size().x),
          diffusion_(grid_.size()) {
        for (std::size_t i = 0; i < grid_.size(); ++i) {
            const double total = static_cast<double>(problem.transport_extinction[i][channel]);
            if (!(total * h_ > least_thickness)) continue;
            const double absorbed = absorption(i);
            diffusion_[i] = (absorbed + total) / (3 * total * total);
            scale_ = std::max(scale_, diffusion_[i]);
        }
    }

    bool is_void() const { return scale_ == 0; }

    int solve(double tolerance, DiffuseLight& out, Job& job) {
        const TileMap::Ptr map = TileMap::box(grid_.cells);
        FaceField weight(map, 0);
        TileField<float> extra(map), right(map), phi(map);
        assemble(weight, extra, right);
        StencilSpec spec;
        spec.map = map;
        spec.sides.fill({SideRule::Kind::Closed, 1});
        spec.fraction = &weight;
        spec.extra = &extra;
        StencilSolver solver(spec);
        const SolveResult result = solver.solve(right, phi, tolerance, most_iterations, job);
        if (!(result.residual <= 10 * tolerance)) {
            throw Error(ErrorKind::Usage, "diffusion",
                        fmt::format("the light does not converge: residual {:.1e} after {} "
                                    "iterations",
                                    result.residual, result.iterations),
                        "raise render.diffusion.tolerance, or take method 'path'");
        }
        for_cells([&](const Vec3i& c, std::size_t i) {
            out.fluence[i][channel_] = diffusion_[i] > 0 ? phi.get(c) : 0.0f;
        });
        for_cells([&](const Vec3i& c, std::size_t i) {
            if (diffusion_[i] == 0) return;
            for (int a = 0; a < 3; ++a) {
                const double flux = 0.5 * (face_flux(c, a, 1, out) - face_flux(c, a, 0, out));
                out.flux[static_cast<std::size_t>(a)][i][channel_] = static_cast<float>(flux);
            }
        });
        return result.iterations;
    }

  private:
    double absorption(std::size_t i) const {
        return static_cast<double>(grid_.extinction[i][channel_] - grid_.scattering[i][channel_]);
    }
    double moment(std::size_t i, int axis) const {
        return static_cast<double>(problem_.moment[static_cast<std::size_t>(axis)][i][channel_]);
    }

    template <class F>
    void for_cells(F&& f) const {
        for (std::size_t i = 0; i < grid_.size(); ++i) f(grid_.cell(i), i);
    }

    // The cell beyond a face, or its own where there is none or nothing diffuses.
    std::size_t beyond(const Vec3i& c, std::size_t i, int axis, int end) const {
        Vec3i n = c;
        n[axis] += end == 0 ? -1 : 1;
        if (n[axis] < 0 || n[axis] >= grid_.cells[axis]) return i;
        const std::size_t j = grid_.index(n);
        return diffusion_[j] > 0 ? j : i;
    }
    double between(std::size_t i, std::size_t j) const {
        return 2 * diffusion_[i] * diffusion_[j] / (diffusion_[i] + diffusion_[j]);
    }
    // phi = z F n / D at a face half a cell away, z being the distance at which phi would vanish
    // beyond it: F = (phi + 3/2 h moment n) times this. Steps of cells around a round medium have
    // |n_x| + |n_y| + |n_z| times its area, so they let out as much less.
    double leak(const Vec3i& c, std::size_t i) const {
        const double z =
            extrapolation / static_cast<double>(problem_.transport_extinction[i][channel_]);
        return diffusion_[i] / (z + 0.5 * h_) * area_share(c);
    }
    double area_share(const Vec3i& c) const {
        Vec3d n;
        for (int o = 0; o < 27; ++o) {
            const Vec3i way(o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1), q = c + way;
            if (min_component(q) < 0 || min_component(grid_.cells - q) < 1) continue;
            n += static_cast<double>(problem_.transport_extinction[grid_.index(q)][channel_]) *
                 Vec3d(way);
        }
        const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
        return sum > 0 ? length(n) / sum : 1;
    }

    void assemble(FaceField& weight, TileField<float>& extra, TileField<float>& right) const {
        for_cells([&](const Vec3i& c, std::size_t i) {
            if (diffusion_[i] == 0) return;
            double held = absorption(i) * h_ * h_;
            double source = static_cast<double>(problem_.power[i][channel_]) * h_ * h_;
            for (int a = 0; a < 3; ++a) {
                for (int end = 0; end < 2; ++end) {
                    const double way = end == 0 ? -1 : 1;
                    const std::size_t j = beyond(c, i, a, end);
                    if (j == i) {
                        held += h_ * leak(c, i);
                        source -= h_ * 1.5 * h_ * way * moment(i, a) * leak(c, i);
                        continue;
                    }
                    source -= h_ * 1.5 * between(i, j) * way * (moment(i, a) + moment(j, a));
                    Vec3i face = c;
                    face[a] += end;
                    weight.ref(a, face) = static_cast<float>(between(i, j) / scale_);
                }
            }
            extra.ref(c) = static_cast<float>(held / scale_);
            right.ref(c) = static_cast<float>(source / scale_);
        });
    }

    // Out of a cell, W/m^2.
    double face_flux(const Vec3i& c, int axis, int end, const DiffuseLight& light) const {
        const std::size_t i = grid_.index(c), j = beyond(c, i, axis, end);
        const double way = end == 0 ? -1 : 1;
        const auto phi = [&](std::size_t k) {
            return static_cast<double>(light.fluence[k][channel_]);
        };
        if (j == i) return (phi(i) + 1.5 * h_ * way * moment(i, axis)) * leak(c, i);
        return between(i, j) *
               ((phi(i) - phi(j)) / h_ + 1.5 * way * (moment(i, axis) + moment(j, axis)));
    }

    const DiffusionProblem& problem_;
    const ZoneGrid& grid_;
    int channel_;
    double h_, scale_ = 0;
    std::vector<double> diffusion_;  // D in metres; 0 where nothing diffuses
};

// Cells where nothing diffuses take the mean of those around them that are filled, two cells deep.
void fill_around(const ZoneGrid& grid, const std::vector<Vec3f>& extinction,
                 std::vector<Vec3f>& values) {
    const double h = grid.cell_size().x;
    std::vector<char> known(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
        known[i] = static_cast<double>(max_component(extinction[i])) * h > least_thickness;
    }
    for (int layer = 0; layer < 2; ++layer) {
        const std::vector<char> before = known;
        parallel_for(static_cast<int>(grid.size()), 1024, [&](int n) {
            const auto i = static_cast<std::size_t>(n);
            if (before[i]) return;
            const Vec3i c = grid.cell(i);
            Vec3f sum;
            int count = 0;
            for (int o = 0; o < 27; ++o) {
                const Vec3i q = c + Vec3i(o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1);
                if (min_component(q) < 0 || min_component(grid.cells - q) < 1) continue;
                if (!before[grid.index(q)]) continue;
                sum += values[grid.index(q)];
                ++count;
            }
            if (count == 0) return;
            values[i] = sum / Vec3f(static_cast<float>(count));
            known[i] = 1;
        });
    }
}

}  // namespace

DiffuseLight diffuse_light(const DiffusionProblem& problem, double tolerance, Job& job) {
    DiffuseLight light;
    light.fluence.resize(problem.grid.size());
    for (auto& f : light.flux) f.resize(problem.grid.size());
    for (int c = 0; c < 3; ++c) {
        job.progress(c / 3.0, "diffusion");
        Channel channel(problem, c);
        if (channel.is_void()) continue;
        light.iterations = std::max(light.iterations, channel.solve(tolerance, light, job));
    }
    fill_around(problem.grid, problem.transport_extinction, light.fluence);
    for (auto& f : light.flux) fill_around(problem.grid, problem.transport_extinction, f);
    return light;
}

}  // namespace gischt
