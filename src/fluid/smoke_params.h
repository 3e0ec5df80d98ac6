// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/units.h"
#include "fluid/advect_kernel.h"
#include "fluid/domain.h"
#include "fluid/emitter.h"
#include "fluid/solid.h"

namespace gischt {

// A uniform wind that the air relaxes to, with gusts: smooth noise in time, the same in every run.
struct WindParams {
    Keyed<Vec3d> velocity;      // m/s
    Keyed<double> rate = 0.0;   // 1/s
    double gust_amplitude = 0;  // share of the speed that comes and goes, in all directions
    double gust_time = 1;       // s, between one gust and the next
    std::int64_t seed = 1;

    // Velocity at a time, gusts included.
    Vec3d at(double time) const;
};
const Table<WindParams>& wind_table();

// How well the motion is resolved. Standard: advect, then project, of first order in time. High: of
// second order in time (see smoke_second_order.cpp), with cubic interpolation of what is carried.
enum class Accuracy { Standard, High };

// The motion in the beginning: the same everywhere, or the vortices of Taylor & Green 1937, one
// pair across the domain: u = A sin x cos y cos z, v = -A cos x sin y cos z, without z in 2-D.
enum class InitialFlow { Uniform, TaylorGreen };

enum class VelocityOutput { None, Content, All };

// Which fields a frame has beside density and temperature.
struct SmokeOutput {
    VelocityOutput velocity = VelocityOutput::Content;
    bool pressure = false, vorticity = false;
};
const Table<SmokeOutput>& smoke_output_table();

// A solid of the scene whose surface holds a temperature.
struct SolidHeat {
    std::string solid;            // its name
    Keyed<double> temperature{};  // K
};
const Table<SolidHeat>& solid_heat_table();

// Smoke in air as an incompressible fluid with buoyancy (Boussinesq).
struct SmokeParams {
    DomainParams domain;
    std::vector<EmitterParams> sources;

    double ambient_temperature = gischt::ambient_temperature;  // K
    double reference_density = 1.2;                            // kg/m^3, of air
    double density_weight = 0;                  // kappa: weight of density 1 relative to air
    std::optional<double> thermal_expansion;    // 1/K; unset: 1 / ambient_temperature
    Keyed<double> vorticity_confinement = 0.0;  // epsilon, 1/s
    WindParams wind;
    Keyed<Vec3d> body_acceleration;  // m/s^2, of all air, as by a pressure gradient from outside
    std::optional<double> density_half_life, temperature_half_life;        // s
    double viscosity = 0, thermal_diffusivity = 0, smoke_diffusivity = 0;  // m^2/s
    SolidSlip solid_slip = SolidSlip::FreeSlip;
    std::vector<SolidHeat> solid_heat;  // other solids are insulated
    Vec3d initial_velocity;             // m/s; of vortices x is the largest speed
    InitialFlow initial_flow = InitialFlow::Uniform;

    Accuracy accuracy = Accuracy::Standard;
    AdvectionScheme velocity_advection = AdvectionScheme::MacCormack,
                    density_advection = AdvectionScheme::MacCormack,
                    temperature_advection = AdvectionScheme::MacCormack;
    Interpolation interpolation = Interpolation::Linear;
    double cfl = 2;  // cells that anything may move in a step
    int min_substeps = 1, max_substeps = 32;
    double pressure_tolerance = 1e-4;  // max|r| / max|b|
    int pressure_iterations = 100;
    SmokeOutput output;
};
const Table<SmokeParams>& smoke_table();

}  // namespace gischt
