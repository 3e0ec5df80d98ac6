// SPDX-License-Identifier: Apache-2.0
#include "fluid/domain.h"

#include <fmt/format.h>

#include <cmath>

namespace gischt {

const Table<DomainParams>& domain_table() {
    static const std::vector<Choice<SideKind>> kinds{
        {"open", SideKind::Open,
         "air and smoke pass, as out of a wind tunnel; the pressure outside is constant"},
        {"free_slip", SideKind::FreeSlip, "a smooth wall"},
        {"no_slip", SideKind::NoSlip, "a wall to which the fluid sticks"},
        {"periodic", SideKind::Periodic, "what leaves here enters on the opposite side"},
        {"inflow", SideKind::Inflow, "air comes in as `sides` says"}};
    using P = DomainParams;
    static const Table<P> table =
        Table<P>("domain", "The box that is simulated")
            .add("resolution", &P::resolution,
                 {.help = "Cells along the longest edge", .min = 1, .max = 16384})
            .add("min", &P::min, {.unit = "m", .help = "Lower corner of the box"})
            .add("max", &P::max,
                 {.unit = "m", .help = "Upper corner; with max.z = min.z the domain is 2-D"})
            .choice("x_min", &P::x_min, kinds, {.help = "The side at the lower end of x"})
            .choice("x_max", &P::x_max, kinds, {.help = "The side at the upper end of x"})
            .choice("y_min", &P::y_min, kinds, {.help = "The side at the lower end of y"})
            .choice("y_max", &P::y_max, kinds, {.help = "The side at the upper end of y"})
            .choice("z_min", &P::z_min, kinds, {.help = "The side at the lower end of z"})
            .choice("z_max", &P::z_max, kinds, {.help = "The side at the upper end of z"})
            .sub("sides", &P::sides, sides_table(), {.help = "What the sides hold"});
    return table;
}

static Error bad_domain(std::string what, std::string hint = {}) {
    return {ErrorKind::Usage, "domain", std::move(what), std::move(hint)};
}

Domain::Domain(const DomainParams& p)
    : side{p.x_min, p.x_max, p.y_min, p.y_max, p.z_min, p.z_max}, sides(p.sides.all()) {
    const Vec3d edge = p.max - p.min;
    const double longest = max_component(edge);
    if (!(edge.x > 0 && edge.y > 0 && edge.z >= 0) || !std::isfinite(longest)) {
        throw bad_domain(fmt::format("the box from ({}, {}, {}) to ({}, {}, {}) m is empty",
                                     p.min.x, p.min.y, p.min.z, p.max.x, p.max.y, p.max.z),
                         "every component of max must be larger than that of min");
    }
    if (p.resolution < 1) {
        throw bad_domain(fmt::format("a resolution of {} cells is impossible", p.resolution));
    }
    h = longest / p.resolution;
    for (int a = 0; a < 3; ++a) {
        const double count = std::max(1.0, std::round(edge[a] / h));
        if (count > 1 << 20) throw bad_domain("more than 2^20 cells along an edge");
        cells[a] = static_cast<int>(count);
    }
    map = TileMap::box(cells);
    origin = p.min;
    if (edge.z == 0) origin.z -= 0.5 * h;
    for (int a = 0; a < axes(); ++a) {
        if (is_periodic(a) != (side_of(a, 1) == SideKind::Periodic)) {
            throw bad_domain(fmt::format("{}_min and {}_max must both be periodic or neither",
                                         "xyz"[a], "xyz"[a]));
        }
    }
    check_sides(side, sides, axes());
    held.density.borders = held.temperature.borders = scalar_borders();
}

Borders Domain::scalar_borders() const {
    Borders borders;
    for (std::size_t s = 0; s < 6; ++s) {
        borders.side[s] = side[s] == SideKind::Open || side[s] == SideKind::Inflow ? Border::Zero
                          : side[s] == SideKind::Periodic ? Border::Periodic
                                                          : Border::Even;
    }
    if (is_2d()) borders.side[4] = borders.side[5] = Border::Clamp;
    return borders;
}

Borders Domain::pressure_borders() const {
    Borders borders = scalar_borders();
    for (std::size_t s = 0; s < 6; ++s) {
        if (side[s] == SideKind::Inflow) borders.side[s] = Border::Even;
    }
    return borders;
}

Borders Domain::velocity_borders(int axis) const {
    Borders borders;
    for (std::size_t s = 0; s < 6; ++s) {
        const bool is_normal = static_cast<int>(s / 2) == axis;
        switch (side[s]) {
            case SideKind::Open:
                borders.side[s] = Border::Clamp;
                break;
            case SideKind::FreeSlip:
                borders.side[s] = is_normal ? Border::Odd : Border::Even;
                break;
            case SideKind::NoSlip:
                borders.side[s] = Border::Odd;
                break;
            case SideKind::Periodic:
                borders.side[s] = Border::Periodic;
                break;
            case SideKind::Inflow:
                borders.side[s] = is_normal ? Border::Clamp : Border::Zero;
                break;
        }
    }
    if (is_2d()) borders.side[4] = borders.side[5] = Border::Clamp;
    return borders;
}

Sides Domain::pressure_sides() const {
    Sides rules{};
    for (std::size_t s = 0; s < 6; ++s) {
        rules[s] = side[s] == SideKind::Open       ? Side::Open
                   : side[s] == SideKind::Periodic ? Side::Periodic
                                                   : Side::Wall;
    }
    return rules;
}

}  // namespace gischt
