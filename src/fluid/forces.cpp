// SPDX-License-Identifier: Apache-2.0
#include "fluid/forces.h"

#include <cmath>

namespace gischt {
namespace {

// Slots of the scratch memory of a thread.
constexpr int slot_velocity = 0, slot_vorticity = 3, slot_size = 6, slot_density = 7,
              slot_temperature = 8, slot_out = 9;

Box3i grown(Box3i box, int by, bool is_2d) {
    const Vec3i halo{by, by, is_2d ? 0 : by};
    return {box.lo - halo, box.hi + halo};
}

// Calls f(offset of the row's first cell, its length) for all rows of a box.
template <class F>
void for_rows(const Lattice& lattice, const Box3i& box, F&& f) {
    for (int k = box.lo.z; k < box.hi.z; ++k) {
        for (int j = box.lo.y; j < box.hi.y; ++j) {
            f(lattice.index({box.lo.x, j, k}), box.hi.x - box.lo.x);
        }
    }
}

// Offset of the neighbour along an axis; along z of a 2-D lattice the cell itself, so that
// differences vanish.
std::array<std::ptrdiff_t, 3> strides(const Lattice& lattice, bool is_2d) {
    return {1, lattice.stride_y(), is_2d ? 0 : lattice.stride_z()};
}

// (d u_a / d x_b - d u_b / d x_a) with sign, component by component of a row.
void curl_row(const float* __restrict u, const float* __restrict v, std::ptrdiff_t su,
              std::ptrdiff_t sv, float scale, int n, float* __restrict out) {
    // Component u lives on faces along su and is differentiated along sv; v the other way round.
    for (int i = 0; i < n; ++i) {
        const float du = (u[i + sv] + u[i + sv + su]) - (u[i - sv] + u[i - sv + su]);
        const float dv = (v[i + su] + v[i + su + sv]) - (v[i - su] + v[i - su + sv]);
        out[i] = scale * (dv - du);
    }
}

void size_row(const std::array<float*, 3>& w, std::ptrdiff_t at, int n, bool is_2d,
              float* __restrict out) {
    const float *x = w[0] + at, *y = w[1] + at, *z = w[2] + at;
    if (is_2d) {
        for (int i = 0; i < n; ++i) out[i] = std::abs(z[i]);
    } else {
        for (int i = 0; i < n; ++i) out[i] = std::sqrt((x[i] * x[i] + y[i] * y[i]) + z[i] * z[i]);
    }
}

// Replaces omega by (N x omega) in a row. |grad| far below any real one counts as none.
void confine_row(const float* __restrict size, const std::array<std::ptrdiff_t, 3>& s, int n,
                 bool is_2d, float* __restrict x, float* __restrict y, float* __restrict z) {
    constexpr float tiny = 1e-24f;
    for (int i = 0; i < n; ++i) {
        const float gx = size[i + s[0]] - size[i - s[0]], gy = size[i + s[1]] - size[i - s[1]],
                    gz = size[i + s[2]] - size[i - s[2]];
        const float r = 1 / std::sqrt((gx * gx + gy * gy) + (gz * gz + tiny));
        const float wx = is_2d ? 0.0f : x[i], wy = is_2d ? 0.0f : y[i], wz = z[i];
        x[i] = r * (gy * wz - gz * wy);
        y[i] = r * (gz * wx - gx * wz);
        z[i] = r * (gx * wy - gy * wx);
    }
}

// One block of apply_forces().
class BlockForces {
  public:
    BlockForces(const Domain& domain, const BlockMap& blocks, const Forces& forces, double dt)
        : domain_(domain), blocks_(blocks), forces_(forces), dt_(dt), is_2d_(domain.is_2d()) {}

    void run(int block, const SparseField& density, const SparseField& temperature,
             const FaceField& in, FaceField& out, Scratch& scratch) const {
        const Box3i cells = blocks_.cells(block);
        const bool confines = forces_.confinement != 0;
        const Lattice lattice = Lattice::around(cells, Vec3i(confines ? 3 : 1), true, is_2d_);
        std::array<const float*, 3> u{};
        for (int a = 0; a < domain_.axes(); ++a) {
            float* faces = scratch.array(slot_velocity + a, lattice.count());
            gather_block_faces(in, a, lattice, domain_.velocity_borders(a), faces);
            add_side_velocity(domain_, a, lattice, faces);
            u[static_cast<std::size_t>(a)] = faces;
        }
        std::array<const float*, 3> force{};
        if (confines) force = confinement(lattice, cells, u, scratch);
        const float* rho = load(density, block, lattice, slot_density, scratch);
        const float* theta = load(temperature, block, lattice, slot_temperature, scratch);
        for (int a = 0; a < domain_.axes(); ++a) {
            const Box3i faces = domain_.faces_of(cells, a);
            float* result = scratch.array(slot_out, lattice.count());
            accelerate(lattice, faces, a, u[static_cast<std::size_t>(a)], force, rho, theta,
                       result);
            scatter_block_faces(blocks_, block, a, lattice, result, out);
        }
    }

  private:
    // N x omega at the cells and one layer around them.
    std::array<const float*, 3> confinement(const Lattice& lattice, const Box3i& cells,
                                            const std::array<const float*, 3>& u,
                                            Scratch& scratch) const {
        std::array<float*, 3> w{};
        for (int a = 0; a < 3; ++a) {
            w[static_cast<std::size_t>(a)] = scratch.array(slot_vorticity + a, lattice.count());
        }
        float* size = scratch.array(slot_size, lattice.count());
        const Box3i wide = grown(cells, 2, is_2d_);
        compute_vorticity(lattice, wide, is_2d_, domain_.h, u, w);
        for_rows(lattice, wide,
                 [&](std::ptrdiff_t at, int n) { size_row(w, at, n, is_2d_, size + at); });
        for_rows(lattice, grown(cells, 1, is_2d_), [&](std::ptrdiff_t at, int n) {
            confine_row(size + at, strides(lattice, is_2d_), n, is_2d_, w[0] + at, w[1] + at,
                        w[2] + at);
        });
        return {w[0], w[1], w[2]};
    }

    // The scalar with one layer around the block, or null where all of it is zero.
    const float* load(const SparseField& field, int block, const Lattice& lattice, int slot,
                      Scratch& scratch) const {
        const Vec3i c = blocks_.coord(block), n = blocks_.counts();
        bool active = false;
        for (int k = c.z - 1; k <= c.z + 1; ++k) {
            for (int j = c.y - 1; j <= c.y + 1; ++j) {
                for (int i = c.x - 1; i <= c.x + 1; ++i) {
                    // Beyond an end: the far end, which is the neighbour where it is periodic.
                    const Vec3i at{(i + n.x) % n.x, (j + n.y) % n.y, (k + n.z) % n.z};
                    active |= field.active[static_cast<std::size_t>(blocks_.find(at))] != 0;
                }
            }
        }
        if (!active) return nullptr;
        float* values = scratch.array(slot, lattice.count());
        gather_block(field.values, lattice, domain_.scalar_borders(), values);
        return values;
    }

    void accelerate(const Lattice& lattice, const Box3i& faces, int axis, const float* u,
                    const std::array<const float*, 3>& force, const float* rho, const float* theta,
                    float* out) const {
        const std::ptrdiff_t s = strides(lattice, false)[static_cast<std::size_t>(axis)];
        // Half a step of each of the two cells of a face.
        const double half = 0.5 * dt_;
        const auto by_density =
            static_cast<float>(half * forces_.gravity[axis] * forces_.density_weight);
        const auto by_heat =
            static_cast<float>(-half * forces_.gravity[axis] * forces_.thermal_expansion);
        const auto by_curl = static_cast<float>(half * forces_.confinement * domain_.h);
        const auto relaxed = static_cast<float>(-std::expm1(-forces_.wind_rate * dt_));
        const auto wind = static_cast<float>(forces_.wind[axis]);
        const auto gain = static_cast<float>(dt_ * forces_.acceleration[axis]);
        for_rows(lattice, faces, [&](std::ptrdiff_t at, int n) {
            float* __restrict to = out + at;
            for (int i = 0; i < n; ++i) to[i] = u[at + i];
            const auto add = [&](const float* __restrict f, float factor) {
                for (int i = 0; i < n; ++i) to[i] += factor * (f[i] + f[i - s]);
            };
            if (rho && by_density != 0) add(rho + at, by_density);
            if (theta && by_heat != 0) add(theta + at, by_heat);
            if (force[0]) add(force[static_cast<std::size_t>(axis)] + at, by_curl);
            if (gain != 0) {
                for (int i = 0; i < n; ++i) to[i] += gain;
            }
            if (relaxed != 0) {
                for (int i = 0; i < n; ++i) to[i] += (wind - to[i]) * relaxed;
            }
        });
    }

    const Domain& domain_;
    const BlockMap& blocks_;
    const Forces& forces_;
    double dt_;
    bool is_2d_;
};

}  // namespace

void compute_vorticity(const Lattice& lattice, const Box3i& cells, bool is_2d, double h,
                       const std::array<const float*, 3>& velocity,
                       const std::array<float*, 3>& vorticity) {
    // Two faces make a centre, and the central difference spans two cells: 1 / (2 2h).
    const auto scale = static_cast<float>(0.25 / h);
    const auto s = strides(lattice, is_2d);
    for_rows(lattice, cells, [&](std::ptrdiff_t at, int n) {
        for (std::size_t a = is_2d ? 2 : 0; a < 3; ++a) {
            const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
            curl_row(velocity[b] + at, velocity[c] + at, s[b], s[c], scale, n, vorticity[a] + at);
        }
    });
}

void apply_forces(const Domain& domain, const BlockMap& blocks, const Forces& forces, double dt,
                  const SparseField& density, const SparseField& temperature, const FaceField& in,
                  FaceField& out) {
    const BlockForces work(domain, blocks, forces, dt);
    for_blocks(blocks, [&](int block, Scratch& scratch) {
        work.run(block, density, temperature, in, out, scratch);
    });
}

}  // namespace gischt
