// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/integrals.h"

#include <cmath>
#include <limits>

#include "base/units.h"

namespace gischt {
namespace {

// Slots of the scratch memory of a thread.
constexpr int slot_velocity = 0;

// Volume of a cell; in 2-D per metre of depth.
double volume_of_cell(const Domain& d) {
    return d.is_2d() ? d.h * d.h : d.cell_volume();
}

std::array<std::ptrdiff_t, 3> strides_of(const Lattice& lattice) {
    return {1, lattice.stride_y(), lattice.stride_z()};
}

// Sums over the cells of one block.
class BlockEnergy {
  public:
    BlockEnergy(const SmokeSolver& solver, int block, Scratch& scratch)
        : solver_(solver),
          cells_(solver.blocks().cells(block)),
          lattice_(Lattice::around(cells_, Vec3i(1), true, solver.domain().is_2d())),
          is_cut_(!solver.solids().is_empty() && solver.solids().is_cut(block)) {
        const Domain& d = solver.domain();
        for (int a = 0; a < d.axes(); ++a) {
            float* faces = scratch.array(slot_velocity + a, lattice_.count());
            gather_block_faces(solver.state().velocity, a, lattice_, d.velocity_borders(a), faces);
            add_side_velocity(d, a, lattice_, faces);
            u_[static_cast<std::size_t>(a)] = faces;
        }
    }

    // Half of both faces of each cell and axis: faces between cells count in full, those on sides
    // of the domain, with half a cell behind them, by half.
    double squares() const {
        double sum = 0;
        for (int a = 0; a < solver_.domain().axes(); ++a) {
            const float* u = u_[static_cast<std::size_t>(a)];
            const std::ptrdiff_t s = strides_of(lattice_)[static_cast<std::size_t>(a)];
            for_cells(cells_, [&](const Vec3i& c) {
                const std::ptrdiff_t at = lattice_.index(c);
                double lower = 1, upper = 1;
                if (is_cut_) {
                    Vec3i next = c;
                    next[a] += 1;
                    lower = solver_.solids().fraction().get(a, c);
                    upper = solver_.solids().fraction().get(a, next);
                }
                const double below = u[at], above = u[at + s];
                sum += 0.5 * (lower * below * below + upper * above * above);
            });
        }
        return sum;
    }

    // Mean over the four edges of each cell and axis of the square of the curl there, times h^2.
    double curl_squares() const {
        double sum = 0;
        const auto s = strides_of(lattice_);
        for (std::size_t a = solver_.domain().is_2d() ? 2 : 0; a < 3; ++a) {
            const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
            const auto curl = [&](std::ptrdiff_t i) {
                return static_cast<double>((u_[c][i] - u_[c][i - s[b]]) -
                                           (u_[b][i] - u_[b][i - s[c]]));
            };
            for_cells(cells_, [&](const Vec3i& cell) {
                if (is_covered(cell)) return;
                const std::ptrdiff_t i = lattice_.index(cell);
                for (const std::ptrdiff_t edge : {i, i + s[b], i + s[c], i + s[b] + s[c]}) {
                    sum += 0.25 * curl(edge) * curl(edge);
                }
            });
        }
        return sum;
    }

    double square_speed() const {
        double top = 0;
        const auto s = strides_of(lattice_);
        for_cells(cells_, [&](const Vec3i& cell) {
            if (is_covered(cell)) return;
            const std::ptrdiff_t i = lattice_.index(cell);
            double square = 0;
            for (std::size_t a = 0; a < static_cast<std::size_t>(solver_.domain().axes()); ++a) {
                const double v = 0.5 * (static_cast<double>(u_[a][i]) + u_[a][i + s[a]]);
                square += v * v;
            }
            top = std::max(top, square);
        });
        return top;
    }

  private:
    bool is_covered(const Vec3i& cell) const {
        return is_cut_ && solver_.solids().signed_distance(solver_.domain().center_of(cell)) < 0;
    }

    const SmokeSolver& solver_;
    Box3i cells_;
    Lattice lattice_;
    bool is_cut_;
    std::array<const float*, 3> u_{};
};

// The share of a cell that lies in a box, cell by axis.
double overlap(const Domain& d, const Vec3i& cell, const Box3d& box) {
    double share = 1;
    for (int a = 0; a < d.axes(); ++a) {
        const double lo = d.origin[a] + d.h * cell[a], hi = lo + d.h;
        share *= std::clamp((std::min(hi, box.hi[a]) - std::max(lo, box.lo[a])) / d.h, 0.0, 1.0);
    }
    return share;
}

double integral(const SmokeSolver& solver, const SparseField& field,
                const std::optional<Box3d>& box) {
    const Domain& d = solver.domain();
    const BlockMap& blocks = solver.blocks();
    const double sum = parallel_sum(blocks.size(), 1, [&](int block) {
        if (!field.active[static_cast<std::size_t>(block)]) return 0.0;
        const bool is_cut = !solver.solids().is_empty() && solver.solids().is_cut(block);
        double total = 0;
        for_cells(blocks.cells(block), [&](const Vec3i& c) {
            const double share = box ? overlap(d, c, *box) : 1.0;
            if (share == 0) return;
            if (is_cut && solver.solids().signed_distance(d.center_of(c)) < 0) return;
            total += share * static_cast<double>(field.values.get(c));
        });
        return total;
    });
    return volume_of_cell(d) * sum;
}

// The two cells of a face may lie beyond the domain: their deviation is that of the nearest.
double mean_at_face(const SmokeSolver& solver, const TileField<float>& field, int axis,
                    const Vec3i& face) {
    const int last = solver.domain().cells[axis] - 1;
    Vec3i below = face, above = face;
    below[axis] = std::clamp(face[axis] - 1, 0, last);
    above[axis] = std::clamp(face[axis], 0, last);
    return 0.5 * (static_cast<double>(field.get(below)) + static_cast<double>(field.get(above)));
}

PlumeSample fluxes_through_faces(const SmokeSolver& solver, const UpDirection& up, int layer,
                                 double threshold) {
    const Domain& d = solver.domain();
    const SmokeParams& p = solver.params();
    const double g = length(solver.world().gravity),
                 expansion = p.thermal_expansion.value_or(1 / p.ambient_temperature);
    Box3i faces{{}, d.cells};
    faces.lo[up.axis] = layer;
    faces.hi[up.axis] = layer + 1;
    std::vector<Vec2d> cells;  // upward speed and buoyancy
    double top = 0;
    for_cells(faces, [&](const Vec3i& f) {
        const double theta = mean_at_face(solver, solver.state().temperature.values, up.axis, f),
                     rho = mean_at_face(solver, solver.state().density.values, up.axis, f);
        const double buoyancy = g * (expansion * theta - p.density_weight * rho);
        const double open = solver.solids().is_empty()
                                ? 1.0
                                : static_cast<double>(solver.solids().fraction().get(up.axis, f));
        if (open == 0) return;
        cells.push_back(
            {up.sign * static_cast<double>(solver.state().velocity.get(up.axis, f)), buoyancy});
        top = std::max(top, std::abs(buoyancy));
    });
    PlumeSample s;
    const double area = d.is_2d() ? d.h : d.h * d.h;
    for (const Vec2d& c : cells) {
        if (std::abs(c.y) < threshold * top) continue;
        s.volume_flux += area * c.x;
        s.momentum_flux += area * c.x * c.x;
        s.buoyancy_flux += area * c.x * c.y;
    }
    return s;
}

}  // namespace

EnergySample measure_energy(const SmokeSolver& solver) {
    const auto count = static_cast<std::size_t>(solver.blocks().size());
    std::vector<double> squares(count), curls(count), speeds(count);
    for_blocks(solver.blocks(), [&](int block, Scratch& scratch) {
        const BlockEnergy energy(solver, block, scratch);
        const auto b = static_cast<std::size_t>(block);
        squares[b] = energy.squares();
        curls[b] = energy.curl_squares();
        speeds[b] = energy.square_speed();
    });
    const double cell = volume_of_cell(solver.domain()), h = solver.domain().h;
    EnergySample s;
    s.kinetic_energy = 0.5 * solver.params().reference_density * cell * tree_sum(squares);
    s.enstrophy = 0.5 * cell / (h * h) * tree_sum(curls);
    s.max_speed = std::sqrt(*std::max_element(speeds.begin(), speeds.end()));
    return s;
}

AmountSample measure_amount(const SmokeSolver& solver, const std::optional<Box3d>& box) {
    AmountSample s;
    s.volume = integral(solver, solver.state().density, box);
    s.mass = solver.params().reference_density * s.volume;
    s.heat = integral(solver, solver.state().temperature, box);
    return s;
}

double measure_front(const SmokeSolver& solver, const Vec3d& direction, bool is_density,
                     double threshold) {
    const Domain& d = solver.domain();
    const SparseField& field = is_density ? solver.state().density : solver.state().temperature;
    const double sign = threshold < 0 ? -1 : 1;
    constexpr double none = -std::numeric_limits<double>::infinity();
    std::vector<double> farthest(static_cast<std::size_t>(solver.blocks().size()), none);
    const auto excess = [&](const Vec3i& c) {
        return sign * (static_cast<double>(field.values.get(c)) - threshold);
    };
    parallel_for(solver.blocks().size(), 1, [&](int block) {
        const auto b = static_cast<std::size_t>(block);
        if (!field.active[b]) return;
        for_cells(solver.blocks().cells(block), [&](const Vec3i& c) {
            const double here = excess(c);
            if (here <= 0) return;
            if (solver.solids().signed_distance(d.center_of(c)) < 0) return;
            const double at = dot(direction, d.center_of(c));
            farthest[b] = std::max(farthest[b], at);
            // Towards the neighbours that lie further along the direction and have less.
            for (int a = 0; a < d.axes(); ++a) {
                Vec3i next = c;
                next[a] += direction[a] > 0 ? 1 : -1;
                if (next[a] < 0 || next[a] >= d.cells[a]) continue;
                const double there = excess(next);
                if (there > 0) continue;
                const double way = here / (here - there);
                farthest[b] = std::max(farthest[b], at + way * d.h * std::abs(direction[a]));
            }
        });
    });
    const double front = *std::max_element(farthest.begin(), farthest.end());
    return front == none ? std::numeric_limits<double>::quiet_NaN() : front;
}

UpDirection up_direction(const Vec3d& gravity) {
    const double size = length(gravity);
    for (int a = 0; a < 3; ++a) {
        // The decimals of a scene file must not make a vertical oblique.
        if (size > 0 && std::abs(gravity[a]) > (1 - 1e-9) * size) {
            return {a, gravity[a] < 0 ? 1 : -1};
        }
    }
    throw Error(ErrorKind::Usage, "probe", "gravity does not point along an axis of the grid",
                "a plume is measured on levels of the grid: give gravity along x, y or z");
}

PlumeSample measure_plume(const SmokeSolver& solver, double level, double threshold) {
    const UpDirection up = up_direction(solver.world().gravity);
    const Domain& d = solver.domain();
    const double q = (level - d.origin[up.axis]) / d.h;
    const int layer = std::clamp(static_cast<int>(std::floor(q)), 0, d.cells[up.axis] - 1);
    const double t = q - layer;
    const PlumeSample a = fluxes_through_faces(solver, up, layer, threshold),
                      b = fluxes_through_faces(solver, up, layer + 1, threshold);
    const auto mix = [&](double x, double y) { return (1 - t) * x + t * y; };
    return {mix(a.volume_flux, b.volume_flux), mix(a.momentum_flux, b.momentum_flux),
            mix(a.buoyancy_flux, b.buoyancy_flux)};
}

TopHat top_hat(const PlumeSample& s, bool is_2d) {
    if (!(s.volume_flux > 0 && s.momentum_flux > 0)) return {};
    TopHat t;
    t.speed = s.momentum_flux / s.volume_flux;
    t.gravity = s.buoyancy_flux / s.volume_flux;
    const double area = s.volume_flux / t.speed;
    t.radius = is_2d ? 0.5 * area : std::sqrt(area / pi);
    return t;
}

}  // namespace gischt
