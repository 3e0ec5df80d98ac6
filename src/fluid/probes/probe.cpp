// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/probe.h"

#include <fmt/format.h>

#include <cmath>

#include "fluid/probes/heat_flux.h"
#include "fluid/probes/integrals.h"
#include "fluid/probes/sample.h"
#include "fluid/probes/surface_force.h"

namespace gischt {
namespace {

// Names of vector columns: name_x [unit] ...
void add_vector(std::vector<std::string>& columns, const char* name, const char* unit, bool is_2d) {
    for (int a = 0; a < (is_2d ? 2 : 3); ++a) {
        columns.push_back(fmt::format("{}_{} [{}]", name, "xyz"[a], unit));
    }
}

void add_place(std::vector<std::string>& columns, bool is_2d) {
    for (int a = 0; a < (is_2d ? 2 : 3); ++a) columns.push_back(fmt::format("{} [m]", "xyz"[a]));
}

// What follows the time.
struct ColumnsOf {
    bool is_2d;
    using Columns = std::vector<std::string>;

    Columns operator()(const PointProbe&) const {
        Columns c;
        add_state(c);
        return c;
    }
    Columns operator()(const LineProbe&) const {
        Columns c{"position [m]"};
        add_state(c);
        return c;
    }
    Columns operator()(const EnergyProbe&) const {
        return {is_2d ? "kinetic_energy [J/m]" : "kinetic_energy [J]",
                is_2d ? "enstrophy [m^2/s^2]" : "enstrophy [m^3/s^2]", "max_speed [m/s]"};
    }
    Columns operator()(const HeatFluxProbe& p) const {
        Columns c;
        if (p.local) {
            add_place(c, is_2d);
            c.emplace_back("flux [K m/s]");
        } else {
            c.emplace_back(is_2d ? "flux [K m^2/s]" : "flux [K m^3/s]");
        }
        if (p.length) c.emplace_back("nusselt [1]");
        return c;
    }
    Columns operator()(const ForceProbe& p) const {
        Columns c;
        const char* unit = is_2d ? "N/m" : "N";
        add_vector(c, "force", unit, is_2d);
        add_vector(c, "pressure_force", unit, is_2d);
        add_vector(c, "viscous_force", unit, is_2d);
        if (is_2d) {
            c.emplace_back("torque_z [N]");
        } else {
            add_vector(c, "torque", "N m", false);
        }
        if (p.reference_speed) {
            c.emplace_back("drag_coefficient [1]");
            c.emplace_back("lift_coefficient [1]");
        }
        return c;
    }
    Columns operator()(const MassProbe&) const {
        return {is_2d ? "volume [m^2]" : "volume [m^3]", is_2d ? "mass [kg/m]" : "mass [kg]",
                is_2d ? "heat [K m^2]" : "heat [K m^3]"};
    }
    Columns operator()(const FrontProbe&) const { return {"front [m]"}; }
    Columns operator()(const PlumeProbe&) const {
        return {"height [m]",
                is_2d ? "volume_flux [m^2/s]" : "volume_flux [m^3/s]",
                is_2d ? "momentum_flux [m^3/s^2]" : "momentum_flux [m^4/s^2]",
                is_2d ? "buoyancy_flux [m^3/s^3]" : "buoyancy_flux [m^4/s^3]",
                "radius [m]",
                "speed [m/s]",
                "reduced_gravity [m/s^2]"};
    }

  private:
    void add_state(Columns& c) const {
        add_place(c, is_2d);
        for (int a = 0; a < (is_2d ? 2 : 3); ++a) {
            c.push_back(fmt::format("{} [m/s]", "uvw"[a]));
        }
        for (const char* name : {"pressure [Pa]", "temperature [K]", "density [1]"}) {
            c.emplace_back(name);
        }
    }
};

void add(ProbeRow& row, const Vec3d& v, bool is_2d) {
    for (int a = 0; a < (is_2d ? 2 : 3); ++a) row.push_back(v[a]);
}

Vec3d lift_direction_of(const ForceProbe& p, const Vec3d& gravity, bool is_2d) {
    if (p.lift_direction) return normalize(*p.lift_direction);
    const Vec3d drag = normalize(p.direction);
    if (is_2d) return {-drag.y, drag.x, 0};
    const Vec3d up = -gravity - dot(-gravity, drag) * drag;
    // Where gravity does not tell, any direction across will do.
    if (length(up) > 1e-9 * length(gravity)) return normalize(up);
    const Vec3d other = std::abs(drag.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(1, 0, 0);
    return normalize(other - dot(other, drag) * drag);
}

std::size_t find_solid(const std::string& name, const SmokeSolver& solver) {
    const auto& solids = solver.world().solids;
    std::vector<std::string> names;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        if (solids[s].name == name) return s;
        names.push_back(solids[s].name);
    }
    throw Error(ErrorKind::Usage, "probe",
                fmt::format("no solid '{}' is in the way of the fluid", name),
                names.empty() ? "" : hint_for(name, names));
}

// The rows of one moment.
struct RowsOf {
    const SmokeSolver& solver;
    bool is_2d = solver.domain().is_2d();
    double time = solver.state().time;
    using Rows = std::vector<ProbeRow>;

    Rows operator()(const PointProbe& p) const {
        Rows rows;
        for (const Vec3d& point : p.points) {
            rows.push_back({time});
            add_state(rows.back(), point);
        }
        return rows;
    }
    Rows operator()(const LineProbe& p) const {
        Rows rows(static_cast<std::size_t>(p.count));
        parallel_for(p.count, 16, [&](int i) {
            const double t = static_cast<double>(i) / (p.count - 1);
            ProbeRow& row = rows[static_cast<std::size_t>(i)];
            row = {time, t * length(p.to - p.from)};
            add_state(row, (1 - t) * p.from + t * p.to);  // exact at both ends
        });
        return rows;
    }
    Rows operator()(const EnergyProbe&) const {
        const EnergySample s = measure_energy(solver);
        return {{time, s.kinetic_energy, s.enstrophy, s.max_speed}};
    }
    Rows operator()(const HeatFluxProbe& p) const {
        const int side = static_cast<int>(p.side);
        const SideFlux s = measure_side_flux(solver, side / 2, side % 2, p.wall_temperature);
        // The flux of pure conduction over the length.
        const double unit =
            p.length ? solver.params().thermal_diffusivity * p.delta_temperature.value() / *p.length
                     : 1.0;
        if (!p.local) {
            ProbeRow row{time, s.total};
            if (p.length) row.push_back(s.total / (s.area * unit));
            return {row};
        }
        Rows rows;
        for (std::size_t i = 0; i < s.local.size(); ++i) {
            ProbeRow& row = rows.emplace_back(ProbeRow{time});
            add(row, s.place[i], is_2d);
            row.push_back(s.local[i]);
            if (p.length) row.push_back(s.local[i] / unit);
        }
        return rows;
    }
    Rows operator()(const ForceProbe& p) const {
        const SolidForce f = measure_solid_force(solver, find_solid(p.solid, solver), p.viscous);
        ProbeRow row{time};
        for (const Vec3d& v : {f.total(), f.pressure, f.viscous}) add(row, v, is_2d);
        if (is_2d) {
            row.push_back(f.torque.z);
        } else {
            add(row, f.torque, false);
        }
        if (p.reference_speed) {
            const double unit = 0.5 * solver.params().reference_density * *p.reference_speed *
                                *p.reference_speed * p.reference_area.value();
            const Vec3d lift = lift_direction_of(p, solver.world().gravity, is_2d);
            row.push_back(dot(f.total(), normalize(p.direction)) / unit);
            row.push_back(dot(f.total(), lift) / unit);
        }
        return {row};
    }
    Rows operator()(const MassProbe& p) const {
        std::optional<Box3d> box;
        if (p.min) box = Box3d{*p.min, p.max.value()};
        const AmountSample s = measure_amount(solver, box);
        return {{time, s.volume, s.mass, s.heat}};
    }
    Rows operator()(const FrontProbe& p) const {
        return {{time, measure_front(solver, normalize(p.direction),
                                     p.quantity == FrontQuantity::Density, p.threshold)}};
    }
    Rows operator()(const PlumeProbe& p) const {
        Rows rows;
        const int sign = up_direction(solver.world().gravity).sign;
        for (const double height : p.heights) {
            const PlumeSample s = measure_plume(solver, p.origin + sign * height, p.threshold);
            const TopHat t = top_hat(s, is_2d);
            rows.push_back({time, height, s.volume_flux, s.momentum_flux, s.buoyancy_flux, t.radius,
                            t.speed, t.gravity});
        }
        return rows;
    }

  private:
    void add_state(ProbeRow& row, const Vec3d& point) const {
        const SmokeSample s = sample_smoke(solver, point);
        add(row, point, is_2d);
        add(row, s.velocity, is_2d);
        row.insert(row.end(), {s.pressure, s.temperature, s.density});
    }
};

// Places of a probe against the box of its fluid.
struct CheckOf {
    const DomainParams& domain;
    const Vec3d& gravity;
    bool is_2d = domain.max.z == domain.min.z;

    void operator()(const PointProbe& p) const {
        for (const Vec3d& point : p.points) need_inside(p, point);
    }
    void operator()(const LineProbe& p) const {
        need_inside(p, p.from);
        need_inside(p, p.to);
    }
    void operator()(const HeatFluxProbe& p) const {
        const int side = static_cast<int>(p.side);
        if (is_2d && side >= 4) throw bad(p, "a domain in 2-D has no side along z");
        const std::array<SideKind, 6> kinds{domain.x_min, domain.x_max, domain.y_min,
                                            domain.y_max, domain.z_min, domain.z_max};
        if (kinds[static_cast<std::size_t>(side)] == SideKind::Periodic) {
            throw bad(p, "no heat is conducted through a periodic side");
        }
    }
    void operator()(const PlumeProbe& p) const {
        UpDirection up;
        try {
            up = up_direction(gravity);
        } catch (const Error& e) {
            throw Error(e.kind(), place(p), e.fact(), e.hint());
        }
        if (is_2d && up.axis == 2) {
            throw bad(p, "gravity must point along x or y where the domain is 2-D");
        }
        for (const double height : p.heights) {
            Vec3d level = domain.min;
            level[up.axis] = p.origin + up.sign * height;
            need_inside(p, level);
        }
    }
    void operator()(const ProbeCommon&) const {}

  private:
    static std::string place(const ProbeCommon& p) { return fmt::format("probe '{}'", p.name); }
    static Error bad(const ProbeCommon& p, std::string what) {
        return {ErrorKind::Usage, place(p), std::move(what)};
    }
    void need_inside(const ProbeCommon& p, const Vec3d& point) const {
        // Corners written as decimals may lie a rounding outside.
        const double slack = 1e-9 * max_component(domain.max - domain.min);
        for (int a = 0; a < (is_2d ? 2 : 3); ++a) {
            if (point[a] >= domain.min[a] - slack && point[a] <= domain.max[a] + slack) continue;
            throw Error(
                ErrorKind::Usage, place(p),
                fmt::format("{} = {} m lies outside of the domain", "xyz"[a], point[a]),
                fmt::format("the domain reaches from {} to {} m", domain.min[a], domain.max[a]));
        }
    }
};

bool is_due(const ProbeCommon& p, double time, bool ends_frame) {
    if (p.every == ProbeEvery::Frame && !ends_frame) return false;
    // Times are sums of steps: a frame may end a rounding before its time.
    const double slack = 1e-9 * std::max(1.0, time);
    return time >= p.start.value_or(0) - slack && (!p.stop || time <= *p.stop + slack);
}

}  // namespace

std::vector<std::string> probe_columns(const ProbeParams& probe, bool is_2d) {
    std::vector<std::string> columns = std::visit(ColumnsOf{is_2d}, probe);
    columns.insert(columns.begin(), "time [s]");
    return columns;
}

std::vector<ProbeRow> measure_probe(const ProbeParams& probe, const SmokeSolver& solver) {
    return std::visit(RowsOf{solver}, probe);
}

void complete_mean(const ProbeParams& probe, bool is_2d, ProbeRow& row) {
    if (!std::holds_alternative<PlumeProbe>(probe)) return;
    const TopHat t = top_hat({row[2], row[3], row[4]}, is_2d);
    row[5] = t.radius;
    row[6] = t.speed;
    row[7] = t.gravity;
}

void check_probe(const ProbeParams& probe, const DomainParams& domain, const Vec3d& gravity) {
    std::visit(CheckOf{domain, gravity}, probe);
}

Probes::Probes(std::vector<ProbeParams> probes, const SmokeSolver& solver)
    : probes_(std::move(probes)), rows_(probes_.size()) {
    for (const ProbeParams& p : probes_) {
        check_probe(p, solver.params().domain, solver.world().gravity);
        if (const auto* force = std::get_if<ForceProbe>(&p)) find_solid(force->solid, solver);
    }
}

void Probes::note(const SmokeSolver& solver, bool ends_frame) {
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        if (!is_due(probe_common(probes_[i]), solver.state().time, ends_frame)) continue;
        for (ProbeRow& row : measure_probe(probes_[i], solver)) rows_[i].push_back(std::move(row));
    }
}

std::vector<std::vector<ProbeRow>> Probes::take() {
    std::vector<std::vector<ProbeRow>> taken(probes_.size());
    std::swap(taken, rows_);
    return taken;
}

}  // namespace gischt
