// SPDX-License-Identifier: Apache-2.0
#include "fluid/side_values.h"

#include <cmath>
#include <vector>

#include "fluid/block.h"
#include "fluid/domain.h"
#include "solve/diffusion.h"

namespace gischt {
namespace {

// How a value beyond a side follows from one inside: factor times it plus `add`.
struct Continued {
    float factor = 1, add = 0;
};

// The same walk as that of gather(): index `i` of an axis with the indices [0, count).
Continued continue_beyond(int i, int count, bool faces, const std::array<Border, 2>& rule,
                          const std::array<float, 2>& held) {
    Continued c;
    while (i < 0 || i >= count) {
        const std::size_t end = i < 0 ? 0 : 1;
        switch (rule[end]) {
            case Border::Clamp:
                return c;
            case Border::Zero:
                return {0, c.add + c.factor * held[end]};
            case Border::Periodic: {
                const int period = faces ? count - 1 : count;
                i = ((i % period) + period) % period;
                continue;
            }
            case Border::Odd:
                c.add += c.factor * 2 * held[end];
                c.factor = -c.factor;
                break;
            case Border::Even:
                break;
        }
        i = end == 0 ? (faces ? -i : -1 - i) : (faces ? 2 * (count - 1) - i : 2 * count - 1 - i);
    }
    return c;
}

// Adds to the points of a lattice beyond the sides what is held there. gather() multiplies by the
// factors of all axes; the values of an axis are seen through the axes after it.
void add_held(const Domain& domain, int face_axis, const Lattice& lattice, const Borders& borders,
              const std::array<float, 6>& held, float* values) {
    std::array<std::vector<Continued>, 3> along;
    bool any = false;
    for (int a = 0; a < 3; ++a) {
        const auto s = static_cast<std::size_t>(2 * a);
        const bool faces = a == face_axis;
        const int count = domain.cells[a] + (faces ? 1 : 0);
        for (int i = lattice.region.lo[a]; i < lattice.region.hi[a]; ++i) {
            along[s / 2].push_back(continue_beyond(
                i, count, faces, {borders.side[s], borders.side[s + 1]}, {held[s], held[s + 1]}));
            any |= along[s / 2].back().add != 0;
        }
    }
    if (!any) return;
    for_rows(lattice.region, [&](const Vec3i& first, int n) {
        const Vec3i d = first - lattice.region.lo;
        const Continued y = along[1][static_cast<std::size_t>(d.y)],
                        z = along[2][static_cast<std::size_t>(d.z)];
        float* row = values + lattice.index(first);
        for (int i = 0; i < n; ++i) {
            row[i] +=
                z.add + z.factor * (y.add + y.factor * along[0][static_cast<std::size_t>(i)].add);
        }
    });
}

bool is_wall(SideKind kind) {
    return kind == SideKind::NoSlip || kind == SideKind::FreeSlip;
}

// 1 at the middle of the side along one axis, falling to 0 at the ends that slow the flow.
double profile_along(const Domain& domain, int axis, double s) {
    const auto slows = [&](int end) {
        const SideKind kind = domain.side_of(axis, end);
        return kind != SideKind::Periodic && kind != SideKind::FreeSlip;
    };
    if (slows(0) && slows(1)) return 4 * s * (1 - s);
    if (slows(0)) return s * (2 - s);
    if (slows(1)) return 1 - s * s;
    return 1;
}

}  // namespace

SideValues side_values_at(const Domain& domain, double time, double ambient) {
    SideValues v;
    v.density.borders = v.temperature.borders = domain.scalar_borders();
    for (std::size_t s = 0; s < 2 * static_cast<std::size_t>(domain.axes()); ++s) {
        const SideParams& p = domain.sides[s];
        if (p.velocity) v.velocity[s] = Vec3f(p.velocity->at(time));
        if (domain.is_2d()) v.velocity[s].z = 0;
        v.is_moving |= v.velocity[s] != Vec3f{};
        if (p.density) v.density.value[s] = static_cast<float>(p.density->at(time));
        if (p.temperature) {
            if (is_wall(domain.side[s])) v.temperature.borders.side[s] = Border::Odd;
            v.temperature.value[s] = static_cast<float>(p.temperature->at(time) - ambient);
        }
        v.density.is_plain &= v.density.value[s] == 0;
        v.temperature.is_plain &= v.temperature.value[s] == 0;
    }
    return v;
}

float inflow_velocity(const Domain& domain, int axis, int end, const Vec3i& face) {
    const auto side = static_cast<std::size_t>(2 * axis + end);
    const float largest = domain.held.velocity[side][axis];
    if (domain.sides[side].profile == SideProfile::Uniform) return largest;
    double share = 1;
    for (int b = 0; b < domain.axes(); ++b) {
        if (b != axis) share *= profile_along(domain, b, (face[b] + 0.5) / domain.cells[b]);
    }
    return static_cast<float>(static_cast<double>(largest) * share);
}

double top_side_speed(const SideValues& values) {
    float top = 0;
    for (const Vec3f& v : values.velocity) top = std::max(top, max_component(abs(v)));
    return static_cast<double>(top);
}

double top_side_value(const ScalarHold& hold) {
    float top = 0;
    for (const float v : hold.value) top = std::max(top, std::abs(v));
    return static_cast<double>(top);
}

void add_side_velocity(const Domain& domain, int axis, const Lattice& lattice, float* values) {
    if (!domain.held.is_moving) return;
    std::array<float, 6> held{};
    for (std::size_t s = 0; s < 6; ++s) {
        // Beyond an inflow the normal component is that of the side itself, which the faces hold.
        if (static_cast<int>(s / 2) != axis) held[s] = domain.held.velocity[s][axis];
    }
    add_held(domain, axis, lattice, domain.velocity_borders(axis), held, values);
}

void add_side_scalar(const Domain& domain, const ScalarHold& hold, const Lattice& lattice,
                     float* values) {
    if (!hold.is_plain) add_held(domain, -1, lattice, hold.borders, hold.value, values);
}

VelocitySides velocity_sides(const Domain& domain) {
    VelocitySides sides;
    for (std::size_t s = 0; s < 6; ++s) {
        switch (domain.side[s]) {
            case SideKind::Open:
                sides.rule.side[s] = Border::Clamp;
                break;
            case SideKind::FreeSlip:
                sides.rule.side[s] = Border::Even;
                break;
            case SideKind::NoSlip:
            case SideKind::Inflow:
                sides.rule.side[s] = Border::Odd;
                break;
            case SideKind::Periodic:
                sides.rule.side[s] = Border::Periodic;
                break;
        }
        sides.velocity[s] = domain.held.velocity[s];
    }
    return sides;
}

ScalarSides scalar_sides(const Domain& domain, const ScalarHold& hold) {
    ScalarSides sides{hold.borders, hold.value};
    for (std::size_t s = 0; s < 6; ++s) {
        if (domain.side[s] == SideKind::Inflow) sides.rule.side[s] = Border::Odd;
    }
    return sides;
}

}  // namespace gischt
