// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "fluid/sides.h"
#include "solve/diffusion.h"

namespace gischt {
namespace {

// Smaller amounts are nothing: far below what a half float or an eye resolves, far above the
// denormals that a decaying tail would end in.
constexpr float density_floor = 1e-6f;      // 1
constexpr float temperature_floor = 1e-4f;  // K

void check(const SmokeParams& p, const FluidWorld& world) {
    const auto need = [](bool good, const char* what) {
        if (!good) throw Error(ErrorKind::Usage, "smoke", what);
    };
    need(world.fps > 0 && std::isfinite(world.fps), "fps must be larger than 0");
    need(p.ambient_temperature > 0, "ambient_temperature must be larger than 0 K");
    need(p.reference_density > 0, "reference_density must be larger than 0");
    need(p.cfl > 0, "cfl must be larger than 0");
    need(p.min_substeps >= 1 && p.max_substeps >= p.min_substeps,
         "min_substeps must be at least 1 and at most max_substeps");
    need(p.pressure_tolerance > 0, "pressure_tolerance must be larger than 0");
    need(p.pressure_iterations >= 1, "pressure_iterations must be at least 1");
    need(p.viscosity >= 0 && p.thermal_diffusivity >= 0 && p.smoke_diffusivity >= 0,
         "viscosity and diffusivities must not be negative");
    need(p.density_half_life.value_or(1) > 0 && p.temperature_half_life.value_or(1) > 0,
         "half-lives must be larger than 0");
}

const SmokeParams& checked(const SmokeParams& p, const FluidWorld& world) {
    check(p, world);
    return p;
}

float decay(const std::optional<double>& half_life, double dt) {
    return half_life ? static_cast<float>(std::exp(-std::numbers::ln2 * dt / *half_life)) : 1.0f;
}

float largest(const BlockMap& blocks, const SparseField& field) {
    float peak = 0;
    for (int b = 0; b < blocks.size(); ++b) {
        if (!field.active[static_cast<std::size_t>(b)]) continue;
        const float *v = field.values.tile(blocks.first_tile(b)),
                    *end = field.values.tile(blocks.end_tile(b) - 1) + tile_values;
        for (; v != end; ++v) peak = std::max(peak, std::abs(*v));
    }
    return peak;
}

// Zeroes what is below the floor and finds out which blocks are left with anything.
void trim(const BlockMap& blocks, SparseField& field, float floor) {
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

}  // namespace

SmokeSolver::SmokeSolver(const SmokeParams& params, const FluidWorld& world)
    : params_(checked(params, world)),
      world_(world),
      domain_(params.domain),
      blocks_(domain_.map),
      solids_(domain_, blocks_, world.solids),
      ledger_(domain_, blocks_, solids_),
      emitters_(params.sources, params.ambient_temperature, 1 / world.fps),
      projection_(domain_, blocks_, solids_),
      speeds_(static_cast<std::size_t>(blocks_.size())),
      velocity_predicted_(domain_.map),
      velocity_next_(domain_.map),
      density_predicted_(blocks_, domain_.map),
      density_next_(blocks_, domain_.map),
      temperature_predicted_(blocks_, domain_.map),
      temperature_next_(blocks_, domain_.map) {
    state_.velocity = FaceField(domain_.map);
    state_.potential = TileField<float>(domain_.map);
    state_.density = SparseField(blocks_, domain_.map);
    state_.temperature = SparseField(blocks_, domain_.map);
    if (params_.initial_velocity != Vec3d{}) {
        Job job;
        fill({.velocity = [&](const Vec3d&) { return params_.initial_velocity; },
              .density = nullptr,
              .temperature = nullptr},
             job);
    }
}

double SmokeSolver::thermal_expansion() const {
    return params_.thermal_expansion.value_or(1 / params_.ambient_temperature);
}

StepStatistics SmokeSolver::step(double dt, Job& job) {
    if (!(dt > 0) || !std::isfinite(dt)) {
        throw Error(ErrorKind::Usage, "smoke", fmt::format("a step of {} s is impossible", dt));
    }
    const double time = state_.time + dt;
    ledger_.begin_step(scalars(), state_.velocity, dt);
    {
        PhaseTimer timer(job, "advect");
        advect_all(dt);
    }
    ledger_.note_advection(scalars(), {decay(params_.density_half_life, dt),
                                       decay(params_.temperature_half_life, dt)});
    job.check();
    {
        PhaseTimer timer(job, "solids");
        if (solids_.update(time)) {
            projection_.update_solids();
            ledger_.note_solids(scalars());
        }
    }
    {
        PhaseTimer timer(job, "sources");
        emitters_.apply(domain_, blocks_, time, dt, state_.density, state_.temperature,
                        state_.velocity);
    }
    ledger_.note_sources(scalars());
    diffuse_scalars(dt, job);
    ledger_.note_diffusion(scalars(), {params_.smoke_diffusivity, params_.thermal_diffusivity}, dt);
    {
        PhaseTimer timer(job, "forces");
        apply_forces(domain_, blocks_, forces_at(time), dt, state_.density, state_.temperature,
                     state_.velocity, velocity_next_);
        std::swap(state_.velocity, velocity_next_);
    }
    diffuse_velocity(dt, job);
    job.check();

    const ProjectionResult projected = project(dt, job);
    state_.time = time;
    state_.steps += 1;
    StepStatistics s;
    s.solve = projected.solve;
    s.max_divergence_dt = projected.max_divergence_dt;
    s.kinetic_energy = 0.5 * params_.reference_density * projected.square_speed;
    for (const Vec3f& v : speeds_) {
        s.max_speed = std::max(s.max_speed, static_cast<double>(max_component(v)));
    }
    if (!std::isfinite(s.kinetic_energy)) {
        throw Error(ErrorKind::Resource, "smoke",
                    fmt::format("the velocity became infinite at {:.4g} s", time),
                    "lower cfl, or look for a source or force that is too strong");
    }
    return s;
}

void SmokeSolver::advect_all(double dt) {
    if (!solids_.is_empty()) {
        solids_.extrapolate(state_.density);
        solids_.extrapolate(state_.temperature);
    }
    AdvectedVelocity velocity{&state_.velocity, &velocity_predicted_, &velocity_next_,
                              params_.velocity_advection};
    std::array<AdvectedScalar, 2> scalars{
        AdvectedScalar{&state_.density, &density_predicted_, &density_next_,
                       params_.density_advection, decay(params_.density_half_life, dt),
                       density_floor},
        AdvectedScalar{&state_.temperature, &temperature_predicted_, &temperature_next_,
                       params_.temperature_advection, decay(params_.temperature_half_life, dt),
                       temperature_floor}};
    advect(domain_, blocks_, speeds_, dt, params_.interpolation, velocity, scalars);
}

void SmokeSolver::diffuse_scalars(double dt, Job& job) {
    const PhaseTimer timer(job, "diffusion");
    const ScalarSides sides{domain_.scalar_borders(), {}};
    const FaceField* fraction = solids_.is_empty() ? nullptr : &solids_.fraction();
    const SolveLimits limits;
    const auto spread = [&](SparseField& field, double diffusivity, float floor) {
        if (diffusivity == 0) return;
        const double number = diffusivity * dt / (domain_.h * domain_.h);
        diffuse(field.values, number, sides, fraction, limits, job);
        trim(blocks_, field, floor);
    };
    spread(state_.density, params_.smoke_diffusivity, density_floor);
    spread(state_.temperature, params_.thermal_diffusivity, temperature_floor);
}

void SmokeSolver::diffuse_velocity(double dt, Job& job) {
    if (params_.viscosity == 0) return;
    const PhaseTimer timer(job, "viscosity");
    VelocitySides sides;
    for (std::size_t s = 0; s < 6; ++s) {
        const std::array<Border, 4> rule{Border::Clamp, Border::Even, Border::Odd,
                                         Border::Periodic};
        sides.rule.side[s] = rule[static_cast<std::size_t>(domain_.side[s])];
    }
    close_sides(domain_, state_.velocity);
    diffuse(state_.velocity, params_.viscosity * dt / (domain_.h * domain_.h), sides,
            solids_.is_empty() ? nullptr : &solids_.fraction(), SolidSlip::FreeSlip, SolveLimits{},
            job);
}

Forces SmokeSolver::forces_at(double time) const {
    Forces f;
    f.gravity = world_.gravity;
    f.density_weight = params_.density_weight;
    f.thermal_expansion = thermal_expansion();
    f.confinement = params_.vorticity_confinement.at(time);
    f.wind = params_.wind.at(time);
    f.wind_rate = params_.wind.rate.at(time);
    return f;
}

ProjectionResult SmokeSolver::project(double dt, Job& job) {
    const PhaseTimer timer(job, "project");
    // The pressure changes little from step to step; the potential is dt times it.
    if (state_.potential_dt > 0 && state_.potential_dt != dt) {
        const auto scale = static_cast<float>(dt / state_.potential_dt);
        parallel_for(domain_.map->size(), 64, [&](int t) {
            float* p = state_.potential.tile(t);
            for (int i = 0; i < tile_values; ++i) p[i] *= scale;
        });
    }
    ProjectionResult result =
        projection_.project(state_.velocity, state_.potential, dt, params_.pressure_tolerance,
                            params_.pressure_iterations, speeds_, job);
    state_.potential_dt = dt;
    if (!result.solve.converged) {
        job.warn(
            fmt::format("pressure: residual {:.2e} after {} iterations at {:.4g} s, above "
                        "pressure_tolerance {:.2e}",
                        result.solve.residual, result.solve.iterations, state_.time + dt,
                        params_.pressure_tolerance));
    }
    return result;
}

void SmokeSolver::set_hand(const std::vector<EmitterParams>& hand) {
    std::vector<EmitterParams> all = params_.sources;
    all.insert(all.end(), hand.begin(), hand.end());
    emitters_ = Emitters(std::move(all), params_.ambient_temperature, 1 / world_.fps);
}

double SmokeSolver::longest_step() const {
    double speed = std::max(emitters_.top_speed(state_.time), solids_.top_speed());
    for (const Vec3f& s : speeds_) {
        speed = std::max(speed, static_cast<double>(max_component(s)));
    }
    const double density = std::max<double>(largest(blocks_, state_.density),
                                            emitters_.top_density(state_.time)),
                 heat = std::max<double>(largest(blocks_, state_.temperature),
                                         emitters_.top_temperature(state_.time));
    const double acceleration =
        max_component(abs(world_.gravity)) *
        (std::abs(params_.density_weight) * density + thermal_expansion() * heat);
    // (v + a dt) dt = cfl h, in the form that stays finite for small a.
    const double way = params_.cfl * domain_.h;
    const double root = speed + std::sqrt(speed * speed + 4 * acceleration * way);
    return root > 0 ? 2 * way / root : std::numeric_limits<double>::infinity();
}

double SmokeSolver::density_integral() const {
    const TileField<float>& density = state_.density.values;
    const double all = parallel_sum(domain_.map->size(), 16, [&](int t) {
        double sum = 0;
        const float* v = density.tile(t);
        for (int i = 0; i < tile_values; ++i) sum += static_cast<double>(v[i]);
        return sum;
    });
    return domain_.cell_volume() * (all - solids_.sum_inside(density));
}

void SmokeSolver::fill(const Initial& initial, Job& job) {
    parallel_for(blocks_.size(), 1, [&](int block) {
        const Box3i cells = blocks_.cells(block);
        for_cells(cells, [&](const Vec3i& c) {
            const Vec3d p = domain_.center_of(c);
            if (initial.density) {
                state_.density.values.ref(c) = static_cast<float>(initial.density(p));
            }
            if (initial.temperature) {
                state_.temperature.values.ref(c) =
                    static_cast<float>(initial.temperature(p) - params_.ambient_temperature);
            }
        });
        for (int a = 0; a < domain_.axes() && initial.velocity; ++a) {
            const Box3i faces = domain_.faces_of(cells, a);
            for_cells(faces, [&](const Vec3i& f) {
                state_.velocity.ref(a, f) =
                    static_cast<float>(initial.velocity(domain_.face_center(a, f))[a]);
            });
        }
    });
    trim(blocks_, state_.density, density_floor);
    trim(blocks_, state_.temperature, temperature_floor);
    restart_ledger();
    if (!initial.velocity) return;
    if (initial.project) {
        projection_.project(state_.velocity, state_.potential, 1, params_.pressure_tolerance,
                            params_.pressure_iterations, speeds_, job);
        std::ranges::fill(state_.potential.values(), 0.0f);  // no pressure of a time step
    } else {
        close_sides(domain_, state_.velocity);
        speeds_ = measure_speeds(domain_, blocks_, state_.velocity);
    }
}

void SmokeSolver::set_state(SmokeState state) {
    state_ = std::move(state);
    trim(blocks_, state_.density, 0);
    trim(blocks_, state_.temperature, 0);
    speeds_ = measure_speeds(domain_, blocks_, state_.velocity);
    if (solids_.update(state_.time)) projection_.update_solids();
    ledger_.note_solids(scalars());
    restart_ledger();
}

}  // namespace gischt
