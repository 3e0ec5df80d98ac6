// SPDX-License-Identifier: Apache-2.0
#include "fluid/project.h"

#include <cmath>

#include "fluid/sides.h"

namespace gischt {
namespace {

// Slots of the scratch memory of a thread.
constexpr int slot_velocity = 0, slot_fraction = 3, slot_out = 6, slot_potential = 7;

// The faces of a block's cells, upper ones included; they all exist, so that borders do not matter.
float* load_faces(const FaceField& field, int axis, const Lattice& lattice, int slot,
                  Scratch& scratch) {
    float* faces = scratch.array(slot + axis, lattice.count());
    gather_block_faces(field, axis, lattice, Borders::all(Border::Clamp), faces);
    return faces;
}

// Replaces the velocity by what passes through each face: the fluid through the open part, the
// solid through the rest.
void weigh_by_fractions(const Domain& domain, const SolidField& solids, const Lattice& lattice,
                        int axis, const Box3i& faces, const float* fraction, float* u) {
    for_rows(faces, [&](const Vec3i& first, int n) {
        const std::ptrdiff_t at = lattice.index(first);
        for (int i = 0; i < n; ++i) {
            const float w = fraction[at + i];
            if (w == 1) continue;
            float flux = w * u[at + i];
            if (solids.is_moving()) {
                const Vec3d center = domain.face_center(axis, first + Vec3i(i, 0, 0));
                flux += (1 - w) * static_cast<float>(solids.velocity(center)[axis]);
            }
            u[at + i] = flux;
        }
    });
}

float largest(const Lattice& lattice, const Box3i& box, const float* values) {
    float peak = 0;
    for_rows(box, [&](const Vec3i& first, int n) {
        const float* row = values + lattice.index(first);
        for (int i = 0; i < n; ++i) peak = std::max(peak, std::abs(row[i]));
    });
    return peak;
}

double largest(const TileField<float>& field) {
    return parallel_max(field.map().size(), 64, [&](int t) {
        float peak = 0;
        for (int i = 0; i < tile_values; ++i) peak = std::max(peak, std::abs(field.tile(t)[i]));
        return static_cast<double>(peak);
    });
}

}  // namespace

PressureProjection::PressureProjection(const Domain& domain, const BlockMap& blocks,
                                       const SolidField& solids)
    : domain_(domain), blocks_(blocks), solids_(solids), rhs_(domain.map) {
    update_solids();
}

void PressureProjection::update_solids() {
    solver_ = std::make_unique<PoissonSolver>(domain_.map, domain_.pressure_sides(),
                                              solids_.is_empty() ? nullptr : &solids_.fraction());
}

// Minus the sum of the velocities out of each cell, weighted with the open fractions: the
// right-hand side of the pressure, m/s.
void PressureProjection::flux_sums(const FaceField& velocity, TileField<float>& out) const {
    for_blocks(blocks_, [&](int block, Scratch& scratch) {
        const Box3i cells = blocks_.cells(block);
        const Lattice lattice = Lattice::around(cells, Vec3i(0), true, domain_.is_2d());
        float* sum = scratch.array(slot_out, lattice.count());
        for (int a = 0; a < domain_.axes(); ++a) {
            float* u = load_faces(velocity, a, lattice, slot_velocity, scratch);
            if (!solids_.is_empty() && solids_.is_cut(block)) {
                const float* w = load_faces(solids_.fraction(), a, lattice, slot_fraction, scratch);
                Box3i faces = cells;
                faces.hi[a] += 1;
                weigh_by_fractions(domain_, solids_, lattice, a, faces, w, u);
            }
            const std::ptrdiff_t s = a == 0 ? 1 : a == 1 ? lattice.stride_y() : lattice.stride_z();
            for_rows(cells, [&](const Vec3i& first, int n) {
                const std::ptrdiff_t at = lattice.index(first);
                float* __restrict to = sum + at;
                const float* __restrict from = u + at;
                if (a == 0) {
                    for (int i = 0; i < n; ++i) to[i] = from[i] - from[i + 1];
                } else {
                    for (int i = 0; i < n; ++i) to[i] += from[i] - from[i + s];
                }
            });
        }
        scatter_block(blocks_, block, lattice, sum, out);
    });
}

// As below; returns the integral of u^2 and finds the speeds.
double PressureProjection::subtract_gradient(FaceField& velocity, const TileField<float>& potential,
                                             float factor, BlockSpeeds& speeds) const {
    std::vector<double> squares(static_cast<std::size_t>(blocks_.size()));
    for_blocks(blocks_, [&](int block, Scratch& scratch) {
        const Box3i cells = blocks_.cells(block);
        const Lattice lattice = Lattice::around(cells, Vec3i(1), true, domain_.is_2d());
        float* p = scratch.array(slot_potential, lattice.count());
        gather_block(potential, lattice, domain_.pressure_borders(), p);
        const bool cut = !solids_.is_empty() && solids_.is_cut(block);
        double square = 0;
        Vec3f& speed = speeds[static_cast<std::size_t>(block)];
        for (int a = 0; a < domain_.axes(); ++a) {
            const Box3i faces = domain_.faces_of(cells, a);
            const Lattice own{faces};
            float* u = scratch.array(slot_velocity, own.count());
            gather_block_faces(velocity, a, own, Borders{}, u);
            const float* w = nullptr;
            if (cut) {
                float* fractions = scratch.array(slot_fraction, own.count());
                gather_block_faces(solids_.fraction(), a, own, Borders{}, fractions);
                w = fractions;
            }
            const std::ptrdiff_t s = a == 0 ? 1 : a == 1 ? lattice.stride_y() : lattice.stride_z();
            for_rows(faces, [&](const Vec3i& first, int n) {
                float* __restrict to = u + own.index(first);
                const float* __restrict q = p + lattice.index(first);
                const float* open = w ? w + own.index(first) : nullptr;
                float sum = 0;
                if (open) {
                    for (int i = 0; i < n; ++i) {
                        if (open[i] > 0) to[i] -= factor * (q[i] - q[i - s]);
                        sum += open[i] * to[i] * to[i];
                    }
                } else {
                    for (int i = 0; i < n; ++i) to[i] -= factor * (q[i] - q[i - s]);
                    for (int i = 0; i < n; ++i) sum += to[i] * to[i];
                }
                square += static_cast<double>(sum);
            });
            speed[a] = largest(own, faces, u);
            scatter_block_faces(blocks_, block, a, own, u, velocity);
        }
        squares[static_cast<std::size_t>(block)] = square;
    });
    return tree_sum(squares) * domain_.cell_volume();
}

void PressureProjection::subtract_gradient(FaceField& velocity, const TileField<float>& potential,
                                           float factor) const {
    BlockSpeeds ignored(static_cast<std::size_t>(blocks_.size()));
    subtract_gradient(velocity, potential, factor, ignored);
}

ProjectionResult PressureProjection::project(FaceField& velocity, TileField<float>& potential,
                                             double dt, double tolerance, int max_iterations,
                                             BlockSpeeds& speeds, Job& job) {
    ProjectionResult result;
    close_sides(domain_, velocity);
    flux_sums(velocity, rhs_);
    if (largest(rhs_) > 0) {
        result.solve = solver_->solve(rhs_, potential, tolerance, max_iterations, job);
    } else {
        std::ranges::fill(potential.values(), 0.0f);
        result.solve.converged = true;
    }
    result.square_speed = subtract_gradient(velocity, potential, 1, speeds);
    close_sides(domain_, velocity);
    // What is left, in the same sense: cells inside solids have rigid motion and none.
    flux_sums(velocity, rhs_);
    result.max_divergence_dt = largest(rhs_) * dt / domain_.h;
    if (!solids_.is_empty()) {
        solids_.extrapolate(velocity);
        speeds = measure_speeds(domain_, blocks_, velocity);
    }
    return result;
}

}  // namespace gischt
