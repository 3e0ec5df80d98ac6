// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/probe_params.h"

#include <fmt/format.h>

#include "schema/table.h"

namespace gischt {
namespace {

void check_common(const ProbeCommon& p, const Fail& fail) {
    if (p.name.empty() || p.name.front() == '.' || p.name.find('/') != std::string::npos) {
        fail("name", "must be good for a file: not empty, no '/', no '.' in front");
    }
    if (p.start && p.stop && *p.start > *p.stop) fail("stop", "must not lie before start");
}

const Table<ProbeCommon>& common_table() {
    using P = ProbeCommon;
    static const Table<P> table =
        Table<P>("probe", "What every probe has")
            .add("name", &P::name, {.help = "Names its table, NAME.csv", .required = true})
            .add("fluid", &P::fluid,
                 {.help = "Name of the fluid that is measured; not needed where there is one"})
            .choice("every", &P::every,
                    {{"frame", ProbeEvery::Frame},
                     {"step", ProbeEvery::Step, "every time step of the solver"}},
                    {.help = "How often it measures"})
            .add("start", &P::start, {.unit = "s", .help = "Nothing is measured before"})
            .add("stop", &P::stop, {.unit = "s", .help = "Nothing is measured after"})
            .add("mean", &P::mean,
                 {.help = "Write NAME_mean.csv too: the mean over time of every column"})
            .check(check_common);
    return table;
}

const Table<PointProbe>& point_table() {
    using P = PointProbe;
    static const Table<P> table =
        Table<P>("point", "Velocity, pressure, temperature and density at points")
            .base(common_table())
            .add("points", &P::points,
                 {.unit = "m", .help = "Places in the domain", .required = true})
            .check([](const P& p, const Fail& fail) {
                if (p.points.empty()) fail("points", "must not be empty");
            });
    return table;
}

const Table<LineProbe>& line_table() {
    using P = LineProbe;
    static const Table<P> table =
        Table<P>("line", "Velocity, pressure, temperature and density along a line")
            .base(common_table())
            .add("from", &P::from, {.unit = "m", .help = "Its first point", .required = true})
            .add("to", &P::to, {.unit = "m", .help = "Its last point", .required = true})
            .add("count", &P::count,
                 {.help = "Points on it, both ends among them", .min = 2, .max = 1 << 20});
    return table;
}

const Table<EnergyProbe>& energy_table() {
    static const Table<EnergyProbe> table =
        Table<EnergyProbe>("energy", "Kinetic energy, enstrophy and largest speed of the fluid")
            .base(common_table());
    return table;
}

const Table<HeatFluxProbe>& heat_flux_table() {
    using P = HeatFluxProbe;
    static const Table<P> table =
        Table<P>("heat_flux", "Heat conducted into the fluid through a side of the domain")
            .base(common_table())
            .choice("side", &P::side,
                    {{"x_min", DomainSide::XMin},
                     {"x_max", DomainSide::XMax},
                     {"y_min", DomainSide::YMin},
                     {"y_max", DomainSide::YMax},
                     {"z_min", DomainSide::ZMin},
                     {"z_max", DomainSide::ZMax}},
                    {.help = "Which side"})
            .add("wall_temperature", &P::wall_temperature,
                 {.unit = "K",
                  .help = "Of the side; unset: what the domain holds it at",
                  .min = 0,
                  .min_open = true})
            .add("delta_temperature", &P::delta_temperature,
                 {.unit = "K", .help = "Temperature difference of the Nusselt number"})
            .add("length", &P::length,
                 {.unit = "m", .help = "Length of the Nusselt number", .min = 0, .min_open = true})
            .add("local", &P::local, {.help = "A row for each cell on the side"})
            .check([](const P& p, const Fail& fail) {
                if (p.delta_temperature.has_value() != p.length.has_value()) {
                    fail("delta_temperature", "and 'length' make a Nusselt number together only");
                }
                if (p.delta_temperature.value_or(1) == 0) {
                    fail("delta_temperature", "must not be 0");
                }
            });
    return table;
}

const Table<ForceProbe>& force_table() {
    using P = ForceProbe;
    static const Table<P> table =
        Table<P>("force", "Force and torque of the fluid on a solid")
            .base(common_table())
            .add("solid", &P::solid, {.help = "Name of the solid", .required = true})
            .add("viscous", &P::viscous, {.help = "Count the friction, not the pressure alone"})
            .add("reference_speed", &P::reference_speed,
                 {.unit = "m/s",
                  .help = "Speed of the drag and lift coefficients",
                  .min = 0,
                  .min_open = true})
            .add("reference_area", &P::reference_area,
                 {.unit = "m^2",
                  .help = "Area of the coefficients; in 2-D a length in m",
                  .min = 0,
                  .min_open = true})
            .add("direction", &P::direction, {.help = "Direction of the drag"})
            .add("lift_direction", &P::lift_direction,
                 {.help = "Direction of the lift; unset: across the drag, in 2-D to its left, in "
                          "3-D against gravity"})
            .check([](const P& p, const Fail& fail) {
                if (p.reference_speed.has_value() != p.reference_area.has_value()) {
                    fail("reference_speed", "and 'reference_area' make coefficients together only");
                }
                if (!(length(p.direction) > 0)) fail("direction", "must have a length");
                if (p.lift_direction && !(length(*p.lift_direction) > 0)) {
                    fail("lift_direction", "must have a length");
                }
            });
    return table;
}

const Table<MassProbe>& mass_table() {
    using P = MassProbe;
    static const Table<P> table =
        Table<P>("mass", "Smoke and heat in a box or in the whole domain")
            .base(common_table())
            .add("min", &P::min, {.unit = "m", .help = "Lower corner of the box"})
            .add("max", &P::max, {.unit = "m", .help = "Upper corner of the box"})
            .check([](const P& p, const Fail& fail) {
                if (p.min.has_value() != p.max.has_value()) fail("min", "needs 'max' too");
                if (p.min && !(p.min->x < p.max->x && p.min->y < p.max->y)) {
                    fail("max", "must be larger than 'min'");
                }
            });
    return table;
}

const Table<FrontProbe>& front_table() {
    using P = FrontProbe;
    static const Table<P> table =
        Table<P>("front", "How far along a direction there is smoke or heat")
            .base(common_table())
            .add("direction", &P::direction, {.help = "Along which it is looked for"})
            .choice("quantity", &P::quantity,
                    {{"density", FrontQuantity::Density},
                     {"temperature", FrontQuantity::Temperature, "its deviation from the ambient"}},
                    {.help = "What has a front"})
            .add("threshold", &P::threshold,
                 {.help = "Value at the front: density, or kelvins above the ambient temperature; "
                          "negative: below it"})
            .check([](const P& p, const Fail& fail) {
                if (!(length(p.direction) > 0)) fail("direction", "must have a length");
                if (p.threshold == 0) fail("threshold", "must not be 0");
                if (p.threshold < 0 && p.quantity == FrontQuantity::Density) {
                    fail("threshold", "must be larger than 0 for density");
                }
            });
    return table;
}

const Table<PlumeProbe>& plume_table() {
    using P = PlumeProbe;
    static const Table<P> table =
        Table<P>("plume", "Fluxes of a rising plume at heights, and its top-hat radius and speed")
            .base(common_table())
            .add("heights", &P::heights,
                 {.unit = "m", .help = "Heights above origin", .required = true})
            .add("origin", &P::origin,
                 {.unit = "m", .help = "Height of the source along the axis of gravity"})
            .add("threshold", &P::threshold,
                 {.help = "Share of the largest buoyancy at a height from which a cell counts",
                  .min = 0,
                  .max = 1,
                  .max_open = true})
            .check([](const P& p, const Fail& fail) {
                if (p.heights.empty()) fail("heights", "must not be empty");
            });
    return table;
}

}  // namespace

const ProbeCommon& probe_common(const ProbeParams& probe) {
    return std::visit([](const ProbeCommon& p) -> const ProbeCommon& { return p; }, probe);
}

const Variants<ProbeParams>& probe_variants() {
    static const Variants<ProbeParams> variants =
        Variants<ProbeParams>("probe", "Measures a simulated fluid and writes a table, NAME.csv")
            .add("point", point_table())
            .add("line", line_table())
            .add("energy", energy_table())
            .add("heat_flux", heat_flux_table())
            .add("force", force_table())
            .add("mass", mass_table())
            .add("front", front_table())
            .add("plume", plume_table());
    return variants;
}

}  // namespace gischt
