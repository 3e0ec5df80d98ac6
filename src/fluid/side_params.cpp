// SPDX-License-Identifier: Apache-2.0
#include "fluid/side_params.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"

namespace gischt {
namespace {

constexpr std::array<const char*, 6> side_names{"x_min", "x_max", "y_min",
                                                "y_max", "z_min", "z_max"};

[[noreturn]] void refuse(std::size_t side, const char* key, std::string what,
                         std::string hint = {}) {
    throw Error(ErrorKind::Usage, fmt::format("domain.sides.{}{}", side_names[side], key),
                std::move(what), std::move(hint));
}

bool is_finite(const Vec3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_wall(std::size_t side, const SideParams& p) {
    const int axis = static_cast<int>(side / 2);
    for (const Vec3d& v : p.velocity->v) {
        if (v[axis] != 0) {
            refuse(side, ".velocity",
                   fmt::format("a wall that moves with {} m/s along {} goes through itself",
                               v[axis], "xyz"[axis]),
                   "a wall of the domain moves along itself only");
        }
    }
}

void check_inflow(std::size_t side, const SideParams& p) {
    if (!p.velocity) {
        refuse(side, "", "an inflow needs a velocity",
               fmt::format("set domain.sides.{}.velocity", side_names[side]));
    }
    const int axis = static_cast<int>(side / 2);
    for (const Vec3d& v : p.velocity->v) {
        const double inwards = side % 2 == 0 ? v[axis] : -v[axis];
        if (inwards < 0) {
            refuse(side, ".velocity", "points out of the domain",
                   "what leaves takes an open side; turn the sign for an inflow");
        }
        if (p.profile == SideProfile::Parabolic && std::abs(inwards) != length(v)) {
            refuse(side, ".velocity", "a parabolic inflow has no velocity along the side");
        }
    }
}

void check_side(std::size_t side, SideKind kind, const SideParams& p) {
    if (p.velocity) {
        for (const Vec3d& v : p.velocity->v) {
            if (!is_finite(v)) refuse(side, ".velocity", "is not finite");
        }
    }
    for (const auto* scalar : {&p.temperature, &p.density}) {
        for (const double v : *scalar ? (*scalar)->v : std::vector<double>{}) {
            if (!(v >= 0) || !std::isfinite(v)) refuse(side, "", "holds a negative value");
        }
    }
    if (kind == SideKind::Periodic && p.temperature) {
        refuse(side, ".temperature", "a periodic side holds nothing");
    }
    if (p.density && kind != SideKind::Inflow) {
        refuse(side, ".density", "only an inflow brings smoke", "make the side an inflow");
    }
    if (p.profile != SideProfile::Uniform && kind != SideKind::Inflow) {
        refuse(side, ".profile", "only an inflow has a profile");
    }
    if (kind == SideKind::Inflow) return check_inflow(side, p);
    if (!p.velocity) return;
    if (kind != SideKind::NoSlip) {
        refuse(side, ".velocity", "only a no-slip wall and an inflow have a velocity",
               "make the side no_slip or inflow");
    }
    check_wall(side, p);
}

}  // namespace

const Table<SideParams>& side_table() {
    using P = SideParams;
    static const Table<P> table =
        Table<P>("side", "What a side of the domain holds")
            .add("velocity", &P::velocity,
                 {.unit = "m/s", .help = "Of a no-slip wall along itself, or of what flows in"})
            .choice("profile", &P::profile,
                    {{"uniform", SideProfile::Uniform},
                     {"parabolic", SideProfile::Parabolic,
                      "velocity in the middle of the side, 0 where it meets no-slip walls"}},
                    {.help = "How an inflow varies over its side"})
            .add("temperature", &P::temperature,
                 {.unit = "K",
                  .help = "Held at the side; unset: walls are insulated, else the ambient's",
                  .min = 0})
            .add("density", &P::density, {.help = "Smoke that an inflow brings", .min = 0});
    return table;
}

const Table<SidesParams>& sides_table() {
    using P = SidesParams;
    static const Table<P> table =
        Table<P>("sides", "What the sides of the domain hold")
            .sub("x_min", &P::x_min, side_table(), {.help = "At the lower end of x"})
            .sub("x_max", &P::x_max, side_table(), {.help = "At the upper end of x"})
            .sub("y_min", &P::y_min, side_table(), {.help = "At the lower end of y"})
            .sub("y_max", &P::y_max, side_table(), {.help = "At the upper end of y"})
            .sub("z_min", &P::z_min, side_table(), {.help = "At the lower end of z"})
            .sub("z_max", &P::z_max, side_table(), {.help = "At the upper end of z"});
    return table;
}

std::array<SideParams, 6> SidesParams::all() const {
    const auto value = [](const std::optional<SideParams>& p) { return p.value_or(SideParams{}); };
    return {value(x_min), value(x_max), value(y_min), value(y_max), value(z_min), value(z_max)};
}

void check_sides(const std::array<SideKind, 6>& kinds, const std::array<SideParams, 6>& sides,
                 int axes) {
    bool has_open = false, has_inflow = false;
    for (std::size_t s = 0; s < 6; ++s) {
        if (static_cast<int>(s / 2) >= axes) {
            const SideParams& p = sides[s];
            if (p.velocity || p.temperature || p.density) {
                refuse(s, "", "a domain in 2-D has no sides along z");
            }
            continue;
        }
        check_side(s, kinds[s], sides[s]);
        has_open |= kinds[s] == SideKind::Open;
        has_inflow |= kinds[s] == SideKind::Inflow;
    }
    if (has_inflow && !has_open) {
        throw Error(ErrorKind::Usage, "domain", "what flows in cannot leave: no side is open",
                    "make a side open");
    }
}

}  // namespace gischt
