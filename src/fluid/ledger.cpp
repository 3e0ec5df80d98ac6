// SPDX-License-Identifier: Apache-2.0
#include "fluid/ledger.h"

#include <cmath>

#include "solve/diffusion.h"

namespace gischt {

Ledger::Ledger(const Domain& domain, const BlockMap& blocks, const SolidField& solids)
    : domain_(domain), blocks_(blocks), solids_(solids) {
    find_covered();
}

void Ledger::find_covered() {
    covered_.assign(solids_.is_empty() ? 0 : static_cast<std::size_t>(blocks_.size()), {});
    if (covered_.empty()) return;
    parallel_for(blocks_.size(), 1, [&](int block) {
        if (!solids_.is_cut(block)) return;
        const TileMap& map = blocks_.tiles();
        for_cells(blocks_.cells(block), [&](const Vec3i& c) {
            if (solids_.signed_distance(domain_.center_of(c)) >= 0) return;
            const int tile = map.find(map.shape().tile_of(c));
            const Vec3i local = c - map.first_cell(tile);
            const int place = (tile - blocks_.first_tile(block)) * tile_values +
                              map.shape().index(local.x, local.y, local.z);
            covered_[static_cast<std::size_t>(block)].push_back(static_cast<std::uint32_t>(place));
        });
    });
}

// Values of cells beyond the domain are zero.
double Ledger::amount(const SparseField& field) const {
    const double sum = parallel_sum(blocks_.size(), 4, [&](int block) {
        const auto b = static_cast<std::size_t>(block);
        if (!field.active[b]) return 0.0;
        const float* first = field.values.tile(blocks_.first_tile(block));
        double total = 0;
        for (int t = blocks_.first_tile(block); t < blocks_.end_tile(block); ++t) {
            const float* v = field.values.tile(t);
            // Eight sums that a compiler may keep in one register, of terms few enough for float.
            for (int row = 0; row < tile_values; row += 64) {
                std::array<float, 8> part{};
                for (std::size_t i = 0; i < 64; ++i) {
                    part[i % 8] += v[static_cast<std::size_t>(row) + i];
                }
                for (const float p : part) total += static_cast<double>(p);
            }
        }
        if (!covered_.empty()) {
            for (const std::uint32_t place : covered_[b])
                total -= static_cast<double>(first[place]);
        }
        return total;
    });
    return domain_.cell_volume() * sum;
}

// Calls f(axis, end, cell, face) for those of the cells that touch sides of the domain.
template <class F>
static void for_side_cells(const Domain& domain, const Box3i& cells, F&& f) {
    for (int a = 0; a < domain.axes(); ++a) {
        for (const int end : {0, 1}) {
            if (end == 0 ? cells.lo[a] > 0 : cells.hi[a] < domain.cells[a]) continue;
            Box3i layer = cells;
            if (end == 0) {
                layer.hi[a] = layer.lo[a] + 1;
            } else {
                layer.lo[a] = layer.hi[a] - 1;
            }
            for_cells(layer, [&](const Vec3i& cell) {
                Vec3i face = cell;
                face[a] += end;
                f(a, end, cell, face);
            });
        }
    }
}

double Ledger::open_part(int axis, const Vec3i& face) const {
    return solids_.is_empty() ? 1.0 : static_cast<double>(solids_.fraction().get(axis, face));
}

// What leaves through open sides: on each face the volume that passes it in dt, filled as the cells
// behind the face are, layer by layer. What enters there is counted by swept_in().
double Ledger::swept_out(const SparseField& field, const FaceField& velocity, double dt) const {
    const double sum = parallel_sum(blocks_.size(), 1, [&](int block) {
        if (!field.active[static_cast<std::size_t>(block)]) return 0.0;
        double out = 0;
        for_side_cells(
            domain_, blocks_.cells(block), [&](int a, int end, Vec3i at, const Vec3i& face) {
                if (domain_.side_of(a, end) != SideKind::Open) return;
                const double outward =
                    (end == 0 ? -1 : 1) * static_cast<double>(velocity.get(a, face));
                double way = outward * dt / domain_.h * open_part(a, face);  // cells
                while (way > 0 && at[a] >= 0 && at[a] < domain_.cells[a]) {
                    out += std::min(way, 1.0) * static_cast<double>(field.values.get(at));
                    at[a] += end == 0 ? 1 : -1;
                    way -= 1;
                }
            });
        return out;
    });
    return domain_.cell_volume() * sum;
}

// What comes in through inflows, and through open sides that hold what lies outside.
double Ledger::swept_in(const ScalarHold& held, const FaceField& velocity, double dt) const {
    if (held.is_plain) return 0;
    const double sum = parallel_sum(blocks_.size(), 1, [&](int block) {
        double in = 0;
        for_side_cells(
            domain_, blocks_.cells(block), [&](int a, int end, const Vec3i&, const Vec3i& face) {
                const SideKind kind = domain_.side_of(a, end);
                if (kind != SideKind::Open && kind != SideKind::Inflow) return;
                const double inward =
                    (end == 0 ? 1 : -1) * static_cast<double>(velocity.get(a, face));
                in += std::max(inward * dt / domain_.h * open_part(a, face), 0.0) *
                      static_cast<double>(held.value[static_cast<std::size_t>(2 * a + end)]);
            });
        return in;
    });
    return domain_.cell_volume() * sum;
}

// Backward Euler conducts by the differences at its end; see diffuse(), which holds an inflow's
// value on the side itself.
double Ledger::conducted_in(const SparseField& field, const ScalarHold& held, double diffusivity,
                            double dt) const {
    const double number = diffusivity * dt / (domain_.h * domain_.h);
    const Borders borders = scalar_sides(domain_, held).rule;
    const double sum = parallel_sum(blocks_.size(), 1, [&](int block) {
        if (held.is_plain && !field.active[static_cast<std::size_t>(block)]) return 0.0;
        double in = 0;
        for_side_cells(
            domain_, blocks_.cells(block),
            [&](int a, int end, const Vec3i& cell, const Vec3i& face) {
                const Border rule = borders(a, end);
                // Held at the centre of the cell beyond, or on the side itself.
                const double steepness = rule == Border::Zero ? 1 : rule == Border::Odd ? 2 : 0;
                const float beyond = held.value[static_cast<std::size_t>(2 * a + end)];
                in += open_part(a, face) * steepness * number *
                      static_cast<double>(beyond - field.values.get(cell));
            });
        return in;
    });
    return domain_.cell_volume() * sum;
}

const ScalarHold& Ledger::held(std::size_t which) const {
    return which == 0 ? domain_.held.density : domain_.held.temperature;
}

// The change since the last sum.
double Ledger::change(std::size_t which, const SparseField& field) {
    const double now = amount(field), delta = now - ledgers_[which].after;
    ledgers_[which].after = now;
    return delta;
}

void Ledger::begin_step(const Scalars& now, const FaceField& velocity, double dt) {
    const std::array<const SparseField*, 2> fields{now.density, now.temperature};
    for (std::size_t i = 0; i < 2; ++i) {
        const double out = swept_out(*fields[i], velocity, dt),
                     in = swept_in(held(i), velocity, dt);
        ledgers_[i].outflow += out;
        ledgers_[i].inflow += in;
        ledgers_[i].numerical += out - in;  // until advection has carried it
    }
}

void Ledger::note_advection(const Scalars& now, const std::array<double, 2>& decay) {
    const std::array<const SparseField*, 2> fields{now.density, now.temperature};
    for (std::size_t i = 0; i < 2; ++i) {
        const double delta = change(i, *fields[i]);
        const double after = ledgers_[i].after,
                     decayed = after == 0 ? 0.0 : after * (1 / decay[i] - 1);
        ledgers_[i].decayed += decayed;
        ledgers_[i].numerical += delta + decayed;
    }
}

void Ledger::note_solids(const Scalars& now) {
    find_covered();
    ledgers_[0].numerical += change(0, *now.density);
    ledgers_[1].numerical += change(1, *now.temperature);
}

void Ledger::note_sources(const Scalars& now) {
    ledgers_[0].sources += change(0, *now.density);
    ledgers_[1].sources += change(1, *now.temperature);
}

void Ledger::note_diffusion(const Scalars& now, const std::array<double, 2>& diffusivity,
                            double dt) {
    const std::array<const SparseField*, 2> fields{now.density, now.temperature};
    for (std::size_t i = 0; i < 2; ++i) {
        if (diffusivity[i] == 0) continue;
        const double delta = change(i, *fields[i]),
                     conducted = conducted_in(*fields[i], held(i), diffusivity[i], dt);
        ledgers_[i].diffused += conducted;
        ledgers_[i].numerical += delta - conducted;
    }
}

void Ledger::restart(const Scalars& now) {
    ledgers_ = {};
    ledgers_[0].before = ledgers_[0].after = amount(*now.density);
    ledgers_[1].before = ledgers_[1].after = amount(*now.temperature);
}

}  // namespace gischt
