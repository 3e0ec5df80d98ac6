// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke_params.h"

#include "base/random.h"
#include "math/noise.h"

namespace gischt {

Vec3d WindParams::at(double time) const {
    const Vec3d mean = velocity.at(time);
    if (gust_amplitude == 0) return mean;
    // Gradient noise is zero at whole numbers, a quarter is off them; its strength is about 1/2.
    const auto noise = [&](int axis) {
        const Vec3d p(time / gust_time + 0.25, 0.25, 0.5);
        const auto key =
            random_key(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(axis));
        return static_cast<double>(fractal_noise(p, 2, 0.5f, key));
    };
    return mean + (2 * gust_amplitude * length(mean)) * Vec3d(noise(0), noise(1), noise(2));
}

const Table<WindParams>& wind_table() {
    using P = WindParams;
    static const Table<P> table =
        Table<P>("wind", "A wind that the air relaxes to")
            .add("velocity", &P::velocity, {.unit = "m/s", .help = "Mean velocity"})
            .add("rate", &P::rate,
                 {.unit = "1/s", .help = "How fast the air takes it on; 0 is no wind", .min = 0})
            .add("gust_amplitude", &P::gust_amplitude,
                 {.help = "Strength of the gusts as a share of the speed", .min = 0})
            .add("gust_time", &P::gust_time,
                 {.unit = "s", .help = "Between one gust and the next", .min = 0, .min_open = true})
            .add("seed", &P::seed, {.help = "Chooses the gusts"});
    return table;
}

const Table<SmokeOutput>& smoke_output_table() {
    using P = SmokeOutput;
    static const Table<P> table =
        Table<P>("output", "What a frame holds beside density and temperature")
            .choice("velocity", &P::velocity,
                    {{"none", VelocityOutput::None},
                     {"content", VelocityOutput::Content, "where there is smoke or heat"},
                     {"all", VelocityOutput::All, "in the whole domain"}},
                    {.help = "Where velocity is written"})
            .add("pressure", &P::pressure, {.help = "Pressure against the ambient, Pa"})
            .add("vorticity", &P::vorticity, {.help = "Curl of the velocity, 1/s"});
    return table;
}

static const std::vector<Choice<AdvectionScheme>>& schemes() {
    static const std::vector<Choice<AdvectionScheme>> words{
        {"semi_lagrangian", AdvectionScheme::SemiLagrangian, "soft; loses detail"},
        {"maccormack", AdvectionScheme::MacCormack, "second order, twice the work"}};
    return words;
}

static const std::vector<Choice<AdvectionScheme>>& scalar_schemes() {
    static const std::vector<Choice<AdvectionScheme>> words = [] {
        std::vector<Choice<AdvectionScheme>> w = schemes();
        w.push_back({"conservative", AdvectionScheme::Conservative,
                     "nothing is lost or gained; short steps, slower where the air is fast"});
        return w;
    }();
    return words;
}

const Table<SolidHeat>& solid_heat_table() {
    using P = SolidHeat;
    static const Table<P> table =
        Table<P>("solid_heat", "A solid whose surface holds a temperature")
            .add("solid", &P::solid, {.help = "Its name in the scene", .required = true})
            .add("temperature", &P::temperature,
                 {.unit = "K", .help = "Of its surface", .min = 0, .required = true});
    return table;
}

const Table<SmokeParams>& smoke_table() {
    using P = SmokeParams;
    static const Table<P> table =
        Table<P>("smoke", "Smoke and hot air: incompressible flow with buoyancy")
            .sub("domain", &P::domain, domain_table(), {.help = "The box that is simulated"})
            .list("source", &P::sources, emitter_table(), {.help = "Where smoke comes from"})
            .add("ambient_temperature", &P::ambient_temperature,
                 {.unit = "K", .help = "Of the air around", .min = 0, .min_open = true})
            .add("reference_density", &P::reference_density,
                 {.unit = "kg/m^3", .help = "Of the air", .min = 0, .min_open = true})
            .add("density_weight", &P::density_weight,
                 {.help = "Weight of smoke of density 1 relative to air; lets smoke sink"})
            .add("thermal_expansion", &P::thermal_expansion,
                 {.unit = "1/K", .help = "Of air; unset: 1 / ambient_temperature", .min = 0})
            .add("vorticity_confinement", &P::vorticity_confinement,
                 {.unit = "1/s", .help = "Feeds back the eddies that the grid loses", .min = 0})
            .sub("wind", &P::wind, wind_table(), {.help = "A wind with gusts"})
            .add("body_acceleration", &P::body_acceleration,
                 {.unit = "m/s^2", .help = "Of all air; drives a periodic channel"})
            .add("density_half_life", &P::density_half_life,
                 {.unit = "s", .help = "Of smoke; unset: it stays", .min = 0, .min_open = true})
            .add("temperature_half_life", &P::temperature_half_life,
                 {.unit = "s", .help = "Of heat; unset: it stays", .min = 0, .min_open = true})
            .add("viscosity", &P::viscosity,
                 {.unit = "m^2/s", .help = "Kinematic; of air 1.5e-5", .min = 0})
            .add("thermal_diffusivity", &P::thermal_diffusivity,
                 {.unit = "m^2/s", .help = "Spreads heat", .min = 0})
            .add("smoke_diffusivity", &P::smoke_diffusivity,
                 {.unit = "m^2/s", .help = "Spreads smoke", .min = 0})
            .choice("solid_slip", &P::solid_slip,
                    {{"free_slip", SolidSlip::FreeSlip, "it glides along them"},
                     {"no_slip", SolidSlip::NoSlip, "it sticks to them, as far as it is viscous"}},
                    {.help = "What the fluid does at the surface of solids"})
            .list("solid_heat", &P::solid_heat, solid_heat_table(),
                  {.help = "Solids that hold a temperature; the others are insulated"})
            .add("initial_velocity", &P::initial_velocity,
                 {.unit = "m/s", .help = "Of all air in the beginning"})
            .choice("initial_flow", &P::initial_flow,
                    {{"uniform", InitialFlow::Uniform},
                     {"taylor_green", InitialFlow::TaylorGreen,
                      "vortices as wide as half the domain, initial_velocity.x fast"}},
                    {.help = "The motion in the beginning"})
            .choice(
                "accuracy", &P::accuracy,
                {{"standard", Accuracy::Standard, "first order in time"},
                 {"high", Accuracy::High,
                  "second order in time and cubic interpolation, in place of what the advection "
                  "keys say (but for conservative): for detail and for measuring"}},
                {.help = "How well the motion is resolved"})
            .choice("velocity_advection", &P::velocity_advection, schemes(),
                    {.help = "How velocity is carried along"})
            .choice("density_advection", &P::density_advection, scalar_schemes(),
                    {.help = "How smoke is carried along"})
            .choice("temperature_advection", &P::temperature_advection, scalar_schemes(),
                    {.help = "How heat is carried along"})
            .choice("interpolation", &P::interpolation,
                    {{"linear", Interpolation::Linear},
                     {"monotone_cubic", Interpolation::MonotoneCubic, "sharper and slower"},
                     {"cubic", Interpolation::Cubic,
                      "sharper still: velocity may overshoot, smoke and heat are kept in range"}},
                    {.help = "Of the carried values"})
            .add("cfl", &P::cfl,
                 {.help = "Cells that anything may move in a step",
                  .min = 0,
                  .max = 32,
                  .min_open = true})
            .add("min_substeps", &P::min_substeps,
                 {.help = "Fewest steps per frame", .min = 1, .max = 10000})
            .add("max_substeps", &P::max_substeps,
                 {.help = "Most steps per frame; beyond them cfl is exceeded with a warning",
                  .min = 1,
                  .max = 10000})
            .add("pressure_tolerance", &P::pressure_tolerance,
                 {.help = "Residual at which the pressure is good enough",
                  .min = 0,
                  .max = 1,
                  .min_open = true})
            .add("pressure_iterations", &P::pressure_iterations,
                 {.help = "Most iterations of the pressure solver", .min = 1})
            .sub("output", &P::output, smoke_output_table(), {.help = "Fields of a frame"})
            .check([](const P& p, const Fail& fail) {
                if (p.min_substeps > p.max_substeps) {
                    fail("min_substeps", "must not be larger than max_substeps");
                }
            });
    return table;
}

}  // namespace gischt
