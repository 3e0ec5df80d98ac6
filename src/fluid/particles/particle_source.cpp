// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/particle_source.h"

#include <fmt/format.h>

#include "base/parallel.h"
#include "fluid/particles/particle_state.h"

namespace gischt {

ParticleSource::ParticleSource(const ParticleParams& params, const FluidWorld& world,
                               ParticleInputs inputs)
    : system_(params, world, inputs.meshes), inputs_(std::move(inputs)), fps_(world.fps) {}

Frame ParticleSource::frame(int number, Job& job) {
    if (number < frame_) {
        throw Error(
            ErrorKind::Usage, "particles",
            fmt::format("frame {} lies before frame {}, where the simulation is", number, frame_),
            "a simulation runs forward: load a state or start again");
    }
    check_whole();
    while (frame_ < number) {
        is_broken_ = true;
        advance_frame(job);
        is_broken_ = false;
    }
    return make_frame(job);
}

void ParticleSource::check_whole() const {
    if (!is_broken_) return;
    throw Error(ErrorKind::Usage, "particles",
                "the simulation was stopped in the middle of a frame",
                "load a state or start again");
}

std::shared_ptr<const Flow> ParticleSource::flow_at(int number, Job& job) const {
    const std::shared_ptr<const Frame> frame = inputs_.flow(number, job);
    const Field* velocity = frame->find("velocity");
    if (!velocity || !velocity->is_vector()) {
        throw Error(ErrorKind::Usage, "flow", "the fluid's frames have no velocity",
                    "let it write its velocity: output.velocity = \"all\"");
    }
    const Field* density = frame->find("density");
    // Where the field ends the air goes on as at its nearest cells, as far as a frame's motion.
    return std::make_shared<const Flow>(*velocity, density ? *density : *velocity, 1 / fps_, job);
}

// Times are multiples of the step, so that no rounding gathers.
void ParticleSource::advance_frame(Job& job) {
    const double start = now_seconds();
    if (inputs_.flow) {
        const auto begin = flow_number_ == frame_ ? flow_ : flow_at(frame_, job);
        flow_ = flow_at(frame_ + 1, job);
        flow_number_ = frame_ + 1;
        system_.air().set_flow(begin, flow_, frame_ / fps_, (frame_ + 1) / fps_);
    }
    const int steps = system_.params().substeps;
    const auto time = [&](int step) { return (frame_ + static_cast<double>(step) / steps) / fps_; };
    for (int s = 0; s < steps; ++s) {
        job.progress(static_cast<double>(s) / steps, "simulate");
        system_.step(time(s), s + 1 == steps ? (frame_ + 1) / fps_ : time(s + 1), job);
    }
    frame_ += 1;
    statistics_ = {};
    statistics_.steps = steps;
    statistics_.wall_seconds = now_seconds() - start;
}

Frame ParticleSource::make_frame(Job& job) {
    const ParticleParams& p = system_.params();
    Frame frame;
    frame.number = frame_;
    frame.time = frame_ / fps_;
    frame.dt = 1 / fps_;
    Particles particles = system_.seen();
    const SplatLattice lattice = splat_lattice(p.domain);
    splat_particles(particles, lattice, {p.density, p.splat_scale}, frame, job);

    FrameStatistics& s = statistics_;
    s.frame = frame_;
    s.time = frame.time;
    s.cells = static_cast<std::int64_t>(volume(lattice.cells));
    s.active_tiles = frame.find("density")->map().size();
    const auto count = static_cast<int>(particles.size());
    const auto mass = [&](int i) {
        return p.reference_density *
               particle_content(particles, static_cast<std::size_t>(i), p.density);
    };
    const auto speed = [&](int i) {
        return static_cast<double>(length(particles.velocity[static_cast<std::size_t>(i)]));
    };
    s.mass = parallel_sum(count, 4096, mass);
    s.kinetic_energy =
        parallel_sum(count, 4096, [&](int i) { return 0.5 * mass(i) * speed(i) * speed(i); });
    s.max_speed = parallel_max(count, 4096, speed);
    frame.particles["particles"] = std::move(particles);
    return frame;
}

void ParticleSource::save_state(const std::filesystem::path& path) const {
    check_whole();
    save_particle_state(system_.particles(), frame_, path);
}

void ParticleSource::load_state(const std::filesystem::path& path) {
    system_.set_particles(load_particle_state(path, frame_));
    is_broken_ = false;
    flow_number_ = -1;
    statistics_ = {};
    statistics_.frame = frame_;
    statistics_.time = frame_ / fps_;
}

Box3d ParticleSource::bounds() const {
    const ParticleDomain& d = system_.params().domain;
    return {d.min, d.max};
}

SplatLattice splat_lattice(const ParticleDomain& domain) {
    const Vec3d size = domain.max - domain.min;
    const double h = max_component(size) / domain.resolution;
    // 0.5 more rounds to the nearest number of cells.
    return {max(floor(size / h + Vec3d(0.5)), Vec3i(1)), h, domain.min};
}

}  // namespace gischt
