// SPDX-License-Identifier: Apache-2.0
#include "fluid/advect.h"

#include <cmath>

#include "fluid/sides.h"

namespace gischt {
namespace {

// Slots of the scratch memory of a thread.
constexpr int slot_velocity = 0, slot_predicted = 3, slot_out = 6, slot_carried = 7,
              slot_scalars = 10;

// The part of the sweeps that does not change from block to block.
class Sweep {
  public:
    Sweep(const Domain& domain, const BlockMap& blocks, const BlockSpeeds& speeds, double dt,
          Interpolation interpolation)
        : domain_(domain),
          blocks_(blocks),
          speeds_(speeds),
          interpolation_(interpolation),
          dt_over_h_(dt / domain.h) {
        Vec3f peak;
        for (const Vec3f& s : speeds) peak = max(peak, s);
        // Blocks that a trace from any cell of a block may reach, the interpolation's neighbours
        // included. Behind a periodic side the next block may be a narrow rest.
        for (int a = 0; a < domain.axes(); ++a) {
            reach_[a] =
                static_cast<int>(std::ceil((peak[a] * dt_over_h_ + 3) / blocks.extent()[a])) +
                (domain.is_periodic(a) ? 1 : 0);
        }
    }

    // Calls f(block) for the blocks in reach, this one included.
    template <class F>
    void for_reach(int block, F&& f) const {
        const Vec3i c = blocks_.coord(block), n = blocks_.counts();
        for (int k = c.z - reach_.z; k <= c.z + reach_.z; ++k) {
            for (int j = c.y - reach_.y; j <= c.y + reach_.y; ++j) {
                for (int i = c.x - reach_.x; i <= c.x + reach_.x; ++i) {
                    Vec3i at{i, j, k};
                    bool exists = true;
                    for (int a = 0; a < 3; ++a) {
                        if (at[a] >= 0 && at[a] < n[a]) continue;
                        exists &= domain_.is_periodic(a);
                        at[a] = ((at[a] % n[a]) + n[a]) % n[a];
                    }
                    if (exists) f(blocks_.find(at));
                }
            }
        }
    }

    bool is_active(const SparseField& field, int block) const {
        bool active = false;
        for_reach(block, [&](int b) { active |= field.active[static_cast<std::size_t>(b)] != 0; });
        return active;
    }

    // The block with as much halo as its traces need.
    Lattice inputs(int block) const {
        Vec3f speed;
        for_reach(block, [&](int b) { speed = max(speed, speeds_[static_cast<std::size_t>(b)]); });
        Vec3i halo;
        for (int a = 0; a < 3; ++a) {
            halo[a] = static_cast<int>(std::ceil(speed[a] * dt_over_h_)) +
                      (interpolation_ == Interpolation::Linear ? 1 : 2);
        }
        return Lattice::around(blocks_.cells(block), halo, true, domain_.is_2d());
    }

    // The points of a block and a lattice with padded rows for the results.
    AdvectGeometry geometry(int block, const Lattice& in, int face_axis, Lattice& out) const {
        const Box3i cells = blocks_.cells(block);
        AdvectGeometry g;
        g.size = in.size();
        g.first = cells.lo - in.region.lo;
        g.count = cells.size();
        if (face_axis >= 0 && cells.hi[face_axis] == domain_.cells[face_axis]) {
            g.count[face_axis] += 1;
        }
        const Vec3i padded{(g.count.x + 15) / 16 * 16, g.count.y, g.count.z};
        out = {{cells.lo, cells.lo + padded}};
        g.out_stride_y = out.stride_y();
        g.out_stride_z = out.stride_z();
        g.dt_over_h = static_cast<float>(dt_over_h_);
        g.face_axis = face_axis;
        g.is_2d = domain_.is_2d();
        g.interpolation = interpolation_;
        return g;
    }

    const Domain& domain() const { return domain_; }
    const BlockMap& blocks() const { return blocks_; }
    Interpolation interpolation() const { return interpolation_; }

  private:
    const Domain& domain_;
    const BlockMap& blocks_;
    const BlockSpeeds& speeds_;
    Interpolation interpolation_;
    double dt_over_h_;
    Vec3i reach_;
};

bool any_nonzero(const Lattice& lattice, const Vec3i& count, const float* values) {
    for (int k = 0; k < count.z; ++k) {
        for (int j = 0; j < count.y; ++j) {
            const float* row = values + lattice.stride_y() * j + lattice.stride_z() * k;
            float largest = 0;
            for (int i = 0; i < count.x; ++i) largest = std::max(largest, std::abs(row[i]));
            if (largest > 0) return true;
        }
    }
    return false;
}

// One of the two sweeps over the scalars of a block.
class ScalarSweep {
  public:
    ScalarSweep(const Sweep& sweep, std::span<AdvectedScalar> scalars, bool corrects)
        : sweep_(sweep), scalars_(scalars), corrects_(corrects) {}

    void run(int block, const Lattice& in, const std::array<const float*, 3>& velocity,
             Scratch& scratch) const {
        Lattice out;
        AdvectGeometry g = sweep_.geometry(block, in, -1, out);
        g.velocity = velocity;
        std::vector<AdvectedBlock> work;
        std::vector<SparseField*> target;
        for (std::size_t s = 0; s < scalars_.size(); ++s) {
            const AdvectedScalar& q = scalars_[s];
            if (q.scheme == AdvectionScheme::Conservative) continue;
            const bool two_passes = q.scheme == AdvectionScheme::MacCormack;
            if (corrects_ && !two_passes) continue;
            const bool is_last = corrects_ || !two_passes;
            SparseField* to = is_last ? q.next : q.predicted;
            if (!sweep_.is_active(*q.now, block)) {
                clear(block, *to);
                continue;
            }
            work.push_back(load(q, static_cast<int>(s), in, out, scratch));
            if (is_last) {
                work.back().factor = q.factor;
                work.back().floor = q.floor;
            }
            target.push_back(to);
        }
        if (work.empty()) return;
        advect_block(g, work);
        for (std::size_t w = 0; w < work.size(); ++w) {
            scatter_block(sweep_.blocks(), block, out, work[w].out, target[w]->values);
            target[w]->active[static_cast<std::size_t>(block)] =
                any_nonzero(out, g.count, work[w].out);
        }
    }

  private:
    AdvectedBlock load(const AdvectedScalar& q, int s, const Lattice& in, const Lattice& out,
                       Scratch& scratch) const {
        const Domain& domain = sweep_.domain();
        const Borders borders = q.sides ? q.sides->borders : domain.scalar_borders();
        const int slot = slot_scalars + 3 * s;
        AdvectedBlock b;
        float* before = scratch.array(slot, in.count());
        gather_block(q.now->values, in, borders, before);
        if (q.sides) add_side_scalar(domain, *q.sides, in, before);
        b.before = before;
        if (corrects_) {
            float* predicted = scratch.array(slot + 1, in.count());
            gather_block(q.predicted->values, in, borders, predicted);
            if (q.sides) add_side_scalar(domain, *q.sides, in, predicted);
            b.predicted = predicted;
        }
        b.out = scratch.array(slot + 2, out.count());
        b.limited = sweep_.interpolation() == Interpolation::Cubic;
        return b;
    }

    void clear(int block, SparseField& field) const {
        auto& active = field.active[static_cast<std::size_t>(block)];
        if (active) clear_block(sweep_.blocks(), block, field.values);
        active = 0;
    }

    const Sweep& sweep_;
    std::span<AdvectedScalar> scalars_;
    bool corrects_;
};

std::array<const float*, 3> gather_velocity(const Domain& domain, const FaceField& field,
                                            const Lattice& in, int slot, Scratch& scratch) {
    std::array<const float*, 3> out{};
    for (int a = 0; a < domain.axes(); ++a) {
        float* u = scratch.array(slot + a, in.count());
        gather_block_faces(field, a, in, domain.velocity_borders(a), u);
        add_side_velocity(domain, a, in, u);
        out[static_cast<std::size_t>(a)] = u;
    }
    return out;
}

// First or second sweep: all quantities of a block share the velocity around it.
void run_sweep(const Sweep& sweep, const AdvectedVelocity& v, std::span<AdvectedScalar> scalars,
               bool corrects) {
    const ScalarSweep scalar_sweep(sweep, scalars, corrects);
    const bool two_passes = v.scheme == AdvectionScheme::MacCormack;
    FaceField& target = corrects || !two_passes ? *v.next : *v.predicted;
    for_blocks(sweep.blocks(), [&](int block, Scratch& scratch) {
        const Lattice in = sweep.inputs(block);
        const FaceField& through = v.through ? *v.through : *v.now;
        const auto velocity = gather_velocity(sweep.domain(), through, in, slot_velocity, scratch);
        scalar_sweep.run(block, in, velocity, scratch);
        if (corrects && !two_passes) return;
        const auto carried =
            v.through ? gather_velocity(sweep.domain(), *v.now, in, slot_carried, scratch)
                      : velocity;
        std::array<const float*, 3> predicted{};
        if (corrects) {
            predicted = gather_velocity(sweep.domain(), *v.predicted, in, slot_predicted, scratch);
        }
        for (int a = 0; a < sweep.domain().axes(); ++a) {
            Lattice out;
            AdvectGeometry g = sweep.geometry(block, in, a, out);
            g.velocity = velocity;
            AdvectedBlock q;
            q.before = carried[static_cast<std::size_t>(a)];
            q.predicted = predicted[static_cast<std::size_t>(a)];
            q.out = scratch.array(slot_out, out.count());
            advect_block(g, {&q, 1});
            scatter_block_faces(sweep.blocks(), block, a, out, q.out, target);
        }
    });
    close_sides(sweep.domain(), target);
}

}  // namespace

void advect(const Domain& domain, const BlockMap& blocks, const BlockSpeeds& speeds, double dt,
            Interpolation interpolation, AdvectedVelocity& velocity,
            std::span<AdvectedScalar> scalars) {
    const Sweep sweep(domain, blocks, speeds, dt, interpolation);
    for (const AdvectedScalar& s : scalars) {
        if (s.sides) activate_sides(domain, blocks, *s.sides, *s.now);
    }
    bool needs_correction = velocity.scheme == AdvectionScheme::MacCormack;
    for (const AdvectedScalar& s : scalars) {
        needs_correction |= s.scheme == AdvectionScheme::MacCormack;
    }
    run_sweep(sweep, velocity, scalars, false);
    if (needs_correction) run_sweep(sweep, velocity, scalars, true);
    std::swap(*velocity.now, *velocity.next);
    for (const AdvectedScalar& s : scalars) {
        if (s.scheme != AdvectionScheme::Conservative) std::swap(*s.now, *s.next);
    }
}

void drop_small(const BlockMap& blocks, SparseField& field, float floor) {
    parallel_for(blocks.size(), 1, [&](int b) {
        float *v = field.values.tile(blocks.first_tile(b)),
              *end = field.values.tile(blocks.end_tile(b) - 1) + tile_values;
        bool active = false;
        for (; v != end; ++v) {
            if (std::abs(*v) < floor) *v = 0;
            active |= *v != 0;
        }
        field.active[static_cast<std::size_t>(b)] = active;
    });
}

BlockSpeeds measure_speeds(const Domain& domain, const BlockMap& blocks,
                           const FaceField& velocity) {
    BlockSpeeds speeds(static_cast<std::size_t>(blocks.size()));
    for_blocks(blocks, [&](int block, Scratch& scratch) {
        for (int a = 0; a < domain.axes(); ++a) {
            const Box3i faces = domain.faces_of(blocks.cells(block), a);
            const Lattice lattice{faces};
            float* u = scratch.array(slot_velocity, lattice.count());
            gather_block_faces(velocity, a, lattice, Borders{}, u);
            float peak = 0;
            for (std::size_t i = 0; i < lattice.count(); ++i) peak = std::max(peak, std::abs(u[i]));
            speeds[static_cast<std::size_t>(block)][a] = peak;
        }
    });
    return speeds;
}

}  // namespace gischt
