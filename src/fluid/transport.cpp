// SPDX-License-Identifier: Apache-2.0
#include "fluid/transport.h"

#include <cmath>

#include "fluid/sides.h"

namespace gischt {
namespace {

constexpr int slot_value = 0, slot_flux = 1, slot_open = 2, slot_out = 3, slot_start = 4;

// Share of a cell that may flow out in a step: limited slopes of up to twice the difference to the
// neighbour keep their bounds up to one half (Harten 1983).
constexpr double largest_outflow = 0.5;

// Half the slope between the points at -1, 0 and 1, from the differences below and above.
inline float half_slope(float below, float above) {
    const float bound = std::min(2 * std::abs(below), 2 * std::abs(above)),
                third = std::abs(below + 2 * above) / 3, size = std::min(bound, third);
    return below * above > 0 ? std::copysign(0.5f * size, below) : 0.0f;
}

class Transport {
  public:
    Transport(const Domain& domain, const BlockMap& blocks, const FaceField& velocity,
              const FaceField* fraction, const ScalarHold* sides)
        : domain_(domain),
          blocks_(blocks),
          velocity_(velocity),
          fraction_(fraction),
          sides_(sides) {}

    // The block itself or one beside it holds anything.
    bool is_reached(const SparseField& q, int block) const {
        if (q.active[static_cast<std::size_t>(block)]) return true;
        const Vec3i n = blocks_.counts();
        for (int a = 0; a < domain_.axes(); ++a) {
            for (const int step : {-1, 1}) {
                Vec3i at = blocks_.coord(block);
                at[a] += step;
                if (domain_.is_periodic(a)) at[a] = (at[a] + n[a]) % n[a];
                if (at[a] < 0 || at[a] >= n[a]) continue;
                if (q.active[static_cast<std::size_t>(blocks_.find(at))]) return true;
            }
        }
        return false;
    }

    // out = keep start + (1 - keep) (q - dt div(u q)).
    void stage(const SparseField& start, const SparseField& q, float keep, float dt_over_h,
               SparseField& out) const {
        for_blocks(blocks_, [&](int block, Scratch& scratch) {
            auto& active = out.active[static_cast<std::size_t>(block)];
            if (!is_reached(q, block) && !start.active[static_cast<std::size_t>(block)]) {
                if (active) clear_block(blocks_, block, out.values);
                active = 0;
                return;
            }
            const Box3i cells = blocks_.cells(block);
            const Lattice own{cells};
            float* result = scratch.array(slot_out, own.count());
            update(block, q, dt_over_h, scratch, result);
            if (keep > 0) {
                float* before = scratch.array(slot_start, own.count());
                gather_block(start.values, own, Borders{}, before);
                for (std::size_t i = 0; i < own.count(); ++i) {
                    result[i] = keep * before[i] + (1 - keep) * result[i];
                }
            }
            bool any = false;
            for (std::size_t i = 0; i < own.count(); ++i) any |= result[i] != 0;
            scatter_block(blocks_, block, own, result, out.values);
            active = any;
        });
    }

  private:
    void update(int block, const SparseField& q, float dt_over_h, Scratch& scratch,
                float* result) const {
        const Box3i cells = blocks_.cells(block);
        const Lattice own{cells}, around = Lattice::around(cells, Vec3i(2), false, domain_.is_2d());
        float* value = scratch.array(slot_value, around.count());
        gather_block(q.values, around, sides_ ? sides_->borders : domain_.scalar_borders(), value);
        if (sides_) add_side_scalar(domain_, *sides_, around, value);
        for_rows(cells, [&](const Vec3i& first, int n) {
            std::copy_n(value + around.index(first), n, result + own.index(first));
        });
        for (int a = 0; a < domain_.axes(); ++a) {
            Box3i faces = cells;
            faces.hi[a] += 1;
            const Lattice on_faces{faces};
            float* flux = scratch.array(slot_flux, on_faces.count());
            gather_block_faces(velocity_, a, on_faces, domain_.velocity_borders(a), flux);
            if (fraction_) {
                float* open = scratch.array(slot_open, on_faces.count());
                gather_block_faces(*fraction_, a, on_faces, Borders::all(Border::Clamp), open);
                for (std::size_t i = 0; i < on_faces.count(); ++i) flux[i] *= open[i];
            }
            const std::ptrdiff_t s = a == 0 ? 1 : a == 1 ? around.stride_y() : around.stride_z();
            for_rows(faces, [&](const Vec3i& first, int n) {
                fluxes(value + around.index(first), s, n, flux + on_faces.index(first));
            });
            const std::ptrdiff_t up = a == 0   ? 1
                                      : a == 1 ? on_faces.stride_y()
                                               : on_faces.stride_z();
            for_rows(cells, [&](const Vec3i& first, int n) {
                float* __restrict to = result + own.index(first);
                const float* __restrict f = flux + on_faces.index(first);
                for (int i = 0; i < n; ++i) to[i] -= dt_over_h * (f[i + up] - f[i]);
            });
        }
    }

    // Velocities become fluxes: q[i] lies above face i, q[i - s] below.
    static void fluxes(const float* q, std::ptrdiff_t s, int n, float* u) {
        for (int i = 0; i < n; ++i) {
            const float q0 = q[i - 2 * s], q1 = q[i - s], q2 = q[i], q3 = q[i + s];
            const float from_below = q1 + half_slope(q1 - q0, q2 - q1),
                        from_above = q2 + half_slope(q2 - q3, q1 - q2);
            u[i] *= u[i] > 0 ? from_below : from_above;
        }
    }

    const Domain& domain_;
    const BlockMap& blocks_;
    const FaceField& velocity_;
    const FaceField* fraction_;
    const ScalarHold* sides_;
};

// Largest sum of the speeds along the axes where anything is carried, m/s.
double top_speed(const Transport& work, const BlockMap& blocks, const BlockSpeeds& speeds,
                 const SparseField& q) {
    double top = 0;
    for (int b = 0; b < blocks.size(); ++b) {
        if (!work.is_reached(q, b)) continue;
        const Vec3f& v = speeds[static_cast<std::size_t>(b)];
        top = std::max(top, static_cast<double>(v.x + v.y + v.z));
    }
    return top;
}

void finish(const BlockMap& blocks, const AdvectedScalar& q) {
    if (q.factor != 1) {
        parallel_for(blocks.size(), 1, [&](int b) {
            float *v = q.now->values.tile(blocks.first_tile(b)),
                  *end = q.now->values.tile(blocks.end_tile(b) - 1) + tile_values;
            for (; v != end; ++v) *v *= q.factor;
        });
    }
    drop_small(blocks, *q.now, q.floor);
}

}  // namespace

void transport(const Domain& domain, const BlockMap& blocks, const FaceField& velocity,
               const BlockSpeeds& speeds, const FaceField* fraction, double dt, AdvectedScalar& q,
               Job& job) {
    const Transport work(domain, blocks, velocity, fraction, q.sides);
    double rest = dt;
    while (rest > 0) {
        job.check();
        if (q.sides) activate_sides(domain, blocks, *q.sides, *q.now);
        // Anew after every step: smoke may reach faster air.
        const double speed = top_speed(work, blocks, speeds, *q.now);
        const double wanted = rest * speed / (largest_outflow * domain.h);
        const double step = rest / std::max(1.0, std::ceil(wanted * (1 - 1e-9)));
        const auto dt_over_h = static_cast<float>(step / domain.h);
        work.stage(*q.now, *q.now, 0, dt_over_h, *q.predicted);
        work.stage(*q.now, *q.predicted, 0.5f, dt_over_h, *q.next);
        std::swap(*q.now, *q.next);
        rest = wanted <= 1 ? 0 : rest - step;
    }
    finish(blocks, q);
}

}  // namespace gischt
