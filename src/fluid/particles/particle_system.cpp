// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/particle_system.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "base/random.h"

namespace gischt {

ParticleSystem::ParticleSystem(const ParticleParams& params, const FluidWorld& world,
                               std::span<const Mesh> meshes)
    : params_(params),
      solids_(world.solids),
      air_(params.air),
      mover_(params.motion, params.gravity_scale * world.gravity, air_, solids_) {
    if (!(min_component(params.domain.max - params.domain.min) > 0)) {
        throw Error(ErrorKind::Usage, "particles", "the domain is empty",
                    "'max' must be above 'min' in every component");
    }
    const std::uint64_t seed = random_key(static_cast<std::uint64_t>(params.seed));
    for (std::size_t i = 0; i < params.sources.size(); ++i) {
        spouts_.emplace_back(params.sources[i], i < meshes.size() ? meshes[i] : Mesh{},
                             static_cast<int>(i), seed);
    }
}

void ParticleSystem::check_room(double from, double to) const {
    double count = static_cast<double>(particles_.size());
    for (const Spout& s : spouts_) count += s.births(from, to);
    if (count <= params_.most_particles) return;
    throw Error(ErrorKind::Usage, "particles",
                fmt::format("more than {} at {:g} s", params_.most_particles, to),
                "give fewer per second or a shorter life, or raise 'most_particles'");
}

void ParticleSystem::step(double from, double to, Job& job) {
    job.check();
    check_room(from, to);
    const std::size_t old = particles_.size();
    std::vector<double> birth;
    for (const Spout& s : spouts_) s.emit(from, to, particles_, birth);

    mover_.begin_step(to);
    std::vector<std::uint8_t> keep(particles_.size());
    parallel_ranges(static_cast<int>(particles_.size()), 1024, [&](int first, int last) {
        if (job.is_cancelled()) return;
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
            const double begin = i < old ? from : birth[i - old];
            const auto age =
                static_cast<float>(static_cast<double>(particles_.age[i]) + to - begin);
            if (age >= particles_.life[i]) continue;
            PointMotion p{particles_.position[i], Vec3d(particles_.velocity[i])};
            const bool stays =
                mover_.advance(p, static_cast<double>(particles_.radius[i]), begin, to - begin);
            particles_.position[i] = p.position;
            particles_.velocity[i] = Vec3f(p.velocity);
            particles_.age[i] = age;
            const Box3d domain{params_.domain.min, params_.domain.max};
            keep[i] = stays && domain.contains(p.position);
        }
    });
    job.check();
    if (std::ranges::find(keep, 0) != keep.end()) keep_particles(particles_, keep);
}

Particles ParticleSystem::seen() const {
    Particles p = particles_;
    const ParticleLook& look = params_.look;
    if (look.opacity != Keyed<double>(1.0)) p.opacity.resize(p.size());
    if (look.color) p.color.resize(p.size());
    if (look.temperature) p.temperature.resize(p.size());
    parallel_for(static_cast<int>(p.size()), 4096, [&](int n) {
        const auto i = static_cast<std::size_t>(n);
        const double share = static_cast<double>(p.age[i]) / static_cast<double>(p.life[i]);
        p.radius[i] *= static_cast<float>(look.size.at(share));
        if (!p.opacity.empty()) p.opacity[i] = static_cast<float>(look.opacity.at(share));
        if (look.color) p.color[i] = Vec3f(look.color->at(share));
        if (look.temperature) p.temperature[i] = static_cast<float>(look.temperature->at(share));
    });
    return p;
}

}  // namespace gischt
