// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "fluid/sides.h"
#include "fluid/transport.h"
#include "solve/diffusion.h"

namespace gischt {
namespace {

// Smaller amounts are nothing: far below what a half float or an eye resolves, far above the
// denormals that a decaying tail would end in.
constexpr float density_floor = 1e-6f;      // 1
constexpr float temperature_floor = 1e-4f;  // K
// Where nothing may be lost, the floors are lower by this factor.
constexpr float conservative_floor = 1e-4f;

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

// Diffusion is solved a digit better than the pressure: what is left of a steady flow is an error
// of some n^2 / 8 times the residual over n cells.
SolveLimits diffusion_limits(const SmokeParams& p) {
    SolveLimits limits;
    limits.tolerance = std::clamp(0.1 * p.pressure_tolerance, 1e-7, limits.tolerance);
    return limits;
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

}  // namespace

SmokeSolver::SmokeSolver(const SmokeParams& params, const FluidWorld& world)
    : params_(checked(params, world)),
      world_(world),
      domain_(params.domain),
      blocks_(domain_.map),
      solids_(domain_, blocks_, world.solids, params.solid_slip, params.ambient_temperature),
      ledger_(domain_, blocks_, solids_),
      emitters_(params.sources, params.ambient_temperature, 1 / world.fps, domain_.h),
      projection_(domain_, blocks_, solids_),
      speeds_(static_cast<std::size_t>(blocks_.size())),
      velocity_predicted_(domain_.map),
      velocity_next_(domain_.map),
      density_predicted_(blocks_, domain_.map),
      density_next_(blocks_, domain_.map),
      temperature_predicted_(blocks_, domain_.map),
      temperature_next_(blocks_, domain_.map) {
    hold_sides(0);
    state_.velocity = FaceField(domain_.map);
    state_.potential = TileField<float>(domain_.map);
    state_.density = SparseField(blocks_, domain_.map);
    state_.temperature = SparseField(blocks_, domain_.map);
    if (params_.initial_velocity != Vec3d{}) {
        Job job;
        fill({.velocity = [&](const Vec3d& p) { return initial_velocity(p); },
              .density = nullptr,
              .temperature = nullptr},
             job);
    }
}

Vec3d SmokeSolver::initial_velocity(const Vec3d& p) const {
    if (params_.initial_flow == InitialFlow::Uniform) return params_.initial_velocity;
    const Vec3d size = domain_.h * Vec3d(domain_.cells), q = 2 * pi * (p - domain_.origin) / size;
    const double strength = params_.initial_velocity.x * (domain_.is_2d() ? 1.0 : std::cos(q.z));
    // Unequal edges: the second component makes up for the other length.
    return strength * Vec3d(std::sin(q.x) * std::cos(q.y),
                            -std::cos(q.x) * std::sin(q.y) * size.y / size.x, 0);
}

void SmokeSolver::hold_sides(double time) {
    domain_.held = side_values_at(domain_, time, params_.ambient_temperature);
}

double SmokeSolver::thermal_expansion() const {
    return params_.thermal_expansion.value_or(1 / params_.ambient_temperature);
}

StepStatistics SmokeSolver::step(double dt, Job& job) {
    if (!(dt > 0) || !std::isfinite(dt)) {
        throw Error(ErrorKind::Usage, "smoke", fmt::format("a step of {} s is impossible", dt));
    }
    const double time = state_.time + dt;
    hold_sides(time);
    ledger_.begin_step(scalars(), state_.velocity, dt);
    const ProjectionResult projected = is_high() ? step_high(dt, job) : step_standard(dt, job);
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

ProjectionResult SmokeSolver::step_standard(double dt, Job& job) {
    const double time = state_.time + dt;
    {
        const PhaseTimer timer(job, "advect");
        AdvectedVelocity velocity{&state_.velocity, &velocity_predicted_, &velocity_next_,
                                  params_.velocity_advection};
        carry(velocity, speeds_, params_.interpolation, dt, job);
    }
    job.check();
    meet_solids_and_sources(time, dt, job);
    diffuse_scalars(dt, nullptr, job);
    push(time, dt, job);
    diffuse_velocity(dt, job);
    job.check();
    scale_potential(dt);
    return project(dt, job);
}

void SmokeSolver::meet_solids_and_sources(double time, double dt, Job& job) {
    {
        const PhaseTimer timer(job, "solids");
        if (solids_.update(time)) {
            projection_.update_solids();
            ledger_.note_solids(scalars());
        }
    }
    const PhaseTimer timer(job, "sources");
    emitters_.apply(domain_, blocks_, time, dt, state_.density, state_.temperature,
                    state_.velocity);
    ledger_.note_sources(scalars());
}

void SmokeSolver::push(double time, double dt, Job& job) {
    const PhaseTimer timer(job, "forces");
    apply_forces(domain_, blocks_, forces_at(time), dt, state_.density, state_.temperature,
                 state_.velocity, velocity_next_);
    std::swap(state_.velocity, velocity_next_);
}

// Advects the velocity and both scalars.
void SmokeSolver::carry(AdvectedVelocity& velocity, const BlockSpeeds& speeds,
                        Interpolation interpolation, double dt, Job& job) {
    const auto scheme = [&](AdvectionScheme wanted) {
        return is_high() && wanted == AdvectionScheme::MacCormack ? AdvectionScheme::SemiLagrangian
                                                                  : wanted;
    };
    std::array<AdvectedScalar, 2> scalars{
        AdvectedScalar{&state_.density, &density_predicted_, &density_next_,
                       scheme(params_.density_advection), decay(params_.density_half_life, dt),
                       density_floor, &domain_.held.density},
        AdvectedScalar{&state_.temperature, &temperature_predicted_, &temperature_next_,
                       scheme(params_.temperature_advection),
                       decay(params_.temperature_half_life, dt), temperature_floor,
                       &domain_.held.temperature}};
    const FaceField* fraction = solids_.is_empty() ? nullptr : &solids_.fraction();
    for (AdvectedScalar& s : scalars) {
        if (s.scheme == AdvectionScheme::Conservative) {
            s.floor *= conservative_floor;
            const FaceField& through = velocity.through ? *velocity.through : *velocity.now;
            transport(domain_, blocks_, through, speeds, fraction, dt, s, job);
        } else if (fraction != nullptr && s.now == &state_.temperature) {
            solids_.extrapolate_heat(*s.now);
        } else if (fraction != nullptr) {
            solids_.extrapolate(*s.now);
        }
    }
    advect(domain_, blocks_, speeds, dt, interpolation, velocity, scalars);
    ledger_.note_advection(this->scalars(), {decay(params_.density_half_life, dt),
                                             decay(params_.temperature_half_life, dt)});
}

void SmokeSolver::diffuse_scalars(double dt, SmokeHistory* history, Job& job) {
    const PhaseTimer timer(job, "diffusion");
    const SolveLimits limits = diffusion_limits(params_);
    solids_.hold_heat(state_.temperature);
    const auto spread = [&](SparseField& field, const ScalarHold& held, const ScalarSolids& solids,
                            double diffusivity, float floor, TileField<float> SmokeHistory::*kick) {
        if (diffusivity == 0) return;
        if (history) history->*kick = field.values;
        const double number = diffusivity * dt / (domain_.h * domain_.h);
        diffuse(field.values, number, scalar_sides(domain_, held), solids, limits, job);
        if (history) {
            auto& k = (history->*kick).values();
            for (std::size_t i = 0; i < k.size(); ++i) k[i] = field.values.values()[i] - k[i];
        }
        drop_small(blocks_, field, floor);
    };
    spread(state_.density, domain_.held.density, solids_.smoke_solids(), params_.smoke_diffusivity,
           density_floor, &SmokeHistory::density_kick);
    spread(state_.temperature, domain_.held.temperature, solids_.heat_solids(),
           params_.thermal_diffusivity, temperature_floor, &SmokeHistory::temperature_kick);
    note_diffusion(dt);
}

void SmokeSolver::diffuse_velocity(double dt, Job& job) {
    if (params_.viscosity == 0) return;
    const PhaseTimer timer(job, "viscosity");
    close_sides(domain_, state_.velocity);
    solids_.hold(state_.velocity);
    diffuse(state_.velocity, params_.viscosity * dt / (domain_.h * domain_.h),
            velocity_sides(domain_), solids_.velocity_solids(), diffusion_limits(params_), job);
}

Forces SmokeSolver::forces_at(double time) const {
    Forces f;
    f.gravity = world_.gravity;
    f.acceleration = params_.body_acceleration.at(time);
    f.density_weight = params_.density_weight;
    f.thermal_expansion = thermal_expansion();
    f.confinement = params_.vorticity_confinement.at(time);
    f.wind = params_.wind.at(time);
    f.wind_rate = params_.wind.rate.at(time);
    return f;
}

// The pressure changes little from step to step; the potential is dt times it.
void SmokeSolver::scale_potential(double dt) {
    if (state_.potential_dt > 0 && state_.potential_dt != dt) {
        const auto scale = static_cast<float>(dt / state_.potential_dt);
        parallel_for(domain_.map->size(), 64, [&](int t) {
            float* p = state_.potential.tile(t);
            for (int i = 0; i < tile_values; ++i) p[i] *= scale;
        });
    }
}

ProjectionResult SmokeSolver::project(double dt, Job& job) {
    const PhaseTimer timer(job, "project");
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
    emitters_ = Emitters(std::move(all), params_.ambient_temperature, 1 / world_.fps, domain_.h);
}

double SmokeSolver::longest_step() const {
    double speed = std::max(
        {emitters_.top_speed(state_.time), solids_.top_speed(), top_side_speed(domain_.held)});
    for (const Vec3f& s : speeds_) {
        speed = std::max(speed, static_cast<double>(max_component(s)));
    }
    const double density = std::max({static_cast<double>(largest(blocks_, state_.density)),
                                     emitters_.top_density(state_.time),
                                     top_side_value(domain_.held.density)}),
                 heat = std::max({static_cast<double>(largest(blocks_, state_.temperature)),
                                  emitters_.top_temperature(state_.time),
                                  top_side_value(domain_.held.temperature),
                                  solids_.top_temperature()});
    const double acceleration =
        max_component(abs(world_.gravity)) *
            (std::abs(params_.density_weight) * density + thermal_expansion() * heat) +
        max_component(abs(params_.body_acceleration.at(state_.time)));
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
    // Conservative transport has smoke in cells that a solid covers in part, and none in others.
    if (params_.density_advection == AdvectionScheme::Conservative) {
        return domain_.cell_volume() * all;
    }
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
    drop_small(blocks_, state_.density, density_floor);
    drop_small(blocks_, state_.temperature, temperature_floor);
    state_.history = {};
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
    drop_small(blocks_, state_.density, 0);
    drop_small(blocks_, state_.temperature, 0);
    speeds_ = measure_speeds(domain_, blocks_, state_.velocity);
    hold_sides(state_.time);
    if (solids_.update(state_.time)) projection_.update_solids();
    ledger_.note_solids(scalars());
    restart_ledger();
}

}  // namespace gischt
