// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/particle_cloud.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/units.h"
#include "grid/frame.h"
#include "optics/blackbody.h"
#include "optics/medium.h"

namespace gischt {

const Table<ParticleShadingParams>& particle_shading_table() {
    using P = ParticleShadingParams;
    static const Table<P> table =
        Table<P>("particle_shading", "What particles radiate")
            .choice("shading", &P::shading,
                    {{"lit", ParticleShading::Lit,
                      "they scatter the light that reaches them, dimmed by the fluid's medium"},
                     {"glow", ParticleShading::Glow, "black bodies of their temperature"},
                     {"plain", ParticleShading::Plain, "their own colour, whatever the light"}},
                    {.help = "Where their colour comes from"})
            .add("brightness", &P::brightness,
                 {.help = "Factor on their radiance; with 'plain', white is 1 W/(m^2 sr) times it",
                  .min = 0})
            .add("opacity", &P::opacity,
                 {.help = "Factor on the opacity of the particles", .min = 0, .max = 1});
    return table;
}

void ParticleCloud::add(const Particles& p) {
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3f at(p.position[i] - origin_), v = p.velocity[i];
        places_.push_back({at.x, at.y, at.z, p.radius[i]});
        const float share = p.life[i] > 0 ? std::clamp(p.age[i] / p.life[i], 0.0f, 1.0f) : 0;
        motions_.push_back({v.x, v.y, v.z, share});
        const std::uint64_t bits = random_key(p.id[i]);
        const auto chance = [&](int shift) {
            return static_cast<float>((bits >> shift) & 0xffffff) / 16777216.0f;
        };
        chances_.push_back({chance(0), chance(24), 0, 0});
        const Vec3f color = p.color.empty() ? Vec3f(1) : p.color[i];
        const float opacity = p.opacity.empty() ? 1 : p.opacity[i];
        colors_.push_back({color.x, color.y, color.z, opacity});
    }
    set_end_.push_back(places_.size());
}

void ParticleCloud::upload(const View& view, const LitGrid& grid,
                           const ParticleShadingParams& params, std::string_view method) {
    for (auto* list : {&places_, &motions_, &chances_, &colors_}) list->clear();
    medium_of_set_.clear();
    set_end_.clear();
    arriving_.clear();
    is_shaded_ = false;
    Box3d box = Box3d::empty();
    for (const auto& frame : view.frames) {
        for (const auto& [name, particles] : frame->particles) box.extend(particles.bounds());
    }
    const bool is_placed = box.lo.x <= box.hi.x;
    origin_ = is_placed ? 0.5 * (box.lo + box.hi) : Vec3d();
    reach_ = is_placed ? std::max(0.5 * length(box.size()), 1e-3) : 1;
    const BlackbodyTable blackbody;
    std::vector<Vec3f> glow;
    bool has_sets = false;
    for (std::size_t f = 0; f < view.frames.size(); ++f) {
        for (const auto& [name, particles] : view.frames[f]->particles) {
            has_sets = true;
            medium_of_set_.push_back(f);
            add(particles);
            if (params.shading != ParticleShading::Glow) continue;
            if (particles.temperature.empty() && !particles.is_empty()) {
                throw Error(ErrorKind::Usage, std::string(method),
                            "the particles '" + name + "' have no temperature to glow by",
                            "take shading 'lit' or 'plain', or give the fluid temperatures");
            }
            for (const float t : particles.temperature) glow.push_back(blackbody.radiance(t));
        }
    }
    if (!has_sets) {
        throw Error(ErrorKind::Usage, std::string(method), "there are no particles to show",
                    "it shows fluids of type 'particles'; take another method for this scene");
    }
    own_.assign(places_.size(), Vec3f());
    for (std::size_t i = 0; i < own_.size(); ++i) {
        colors_[i][3] *= static_cast<float>(params.opacity);
        if (params.shading == ParticleShading::Lit) continue;
        own_[i] = params.shading == ParticleShading::Glow
                      ? glow[i]
                      : Vec3f(colors_[i][0], colors_[i][1], colors_[i][2]);
    }
    if (params.shading == ParticleShading::Lit) light(view, grid);
    const auto brightness = static_cast<float>(params.brightness);
    for (Vec3f& radiance : own_) radiance *= brightness;
    for (Arriving& a : arriving_) {
        for (Vec3f& radiance : a.radiance) radiance *= brightness;
    }
    place_buffer_ = GlBuffer(device_, places_);
    motion_buffer_ = GlBuffer(device_, motions_);
    chance_buffer_ = GlBuffer(device_, chances_);
    color_buffer_ = GlBuffer(device_, colors_);
}

// What a puff that lets nothing through radiates: albedo times the light that arrives times the
// phase function, the limit of eq. 19 for a thick step.
void ParticleCloud::light(const View& view, const LitGrid& grid) {
    phases_.clear();
    is_even_ = true;
    std::vector<Vec3f> albedo(places_.size());
    for (std::size_t set = 0, i = 0; set < set_end_.size(); ++set) {
        const std::size_t m = medium_of_set_[set];
        const bool has_medium = m < view.media.size();
        Vec3f share(1);
        if (has_medium) {
            const CrossSections& c = view.media[m]->cross_sections();
            const Vec3f e = c.extinction();
            for (int a = 0; a < 3; ++a) share[a] = e[a] > 0 ? c.scattering[a] / e[a] : 1;
        }
        phases_.push_back(has_medium ? view.media[m]->phase() : PhaseFunction{});
        is_even_ = is_even_ && value(phases_.back(), 1) == value(phases_.back(), -1) &&
                   value(phases_.back(), 1) == value(phases_.back(), 0);
        for (; i < set_end_[set]; ++i) {
            albedo[i] = share * Vec3f(colors_[i][0], colors_[i][1], colors_[i][2]);
        }
    }
    const auto count = static_cast<int>(places_.size());
    const auto point = [&](std::size_t i) {
        return origin_ + Vec3d(static_cast<double>(places_[i][0]),
                               static_cast<double>(places_[i][1]),
                               static_cast<double>(places_[i][2]));
    };
    for (const GridLight& light : grid.lights) {
        Arriving a;
        a.is_infinite = light.is_infinite;
        a.place = Vec3f(light.is_infinite ? light.place : light.place - origin_);
        a.radiance.resize(places_.size());
        parallel_for(count, 256, [&](int n) {
            const auto i = static_cast<std::size_t>(n);
            const Vec3d p = point(i);
            const LightSample s = light.light->sample(p, {0.5f, 0.5f});
            if (max_component(s.weight) <= 0 ||
                view.surfaces.is_blocked({p, s.direction, 0, s.distance})) {
                return;
            }
            a.radiance[i] = albedo[i] * s.weight * grid.transmittance(light, p, s.direction);
        });
        arriving_.push_back(std::move(a));
    }
    for (const Light* light : grid.broad) {
        parallel_for(count, 256, [&](int n) {
            const auto i = static_cast<std::size_t>(n);
            const Vec3d p = point(i);
            own_[i] += grid.sky_seen(p) * albedo[i] * light->mean_radiance(p);
        });
    }
}

double ParticleCloud::largest_in_pixels(const GlCamera& camera) const {
    float most = 0;
    for (const Four& p : places_) {
        const float z = dot(Vec3f(p[0], p[1], p[2]) - camera.position, camera.forward);
        if (z < -p[3]) continue;
        if (camera.is_perspective && z <= p[3]) return std::numeric_limits<double>::infinity();
        most = std::max(most, camera.is_perspective ? p[3] / z : p[3]);
    }
    return static_cast<double>(most * 0.5f * camera.picture.y / camera.half.y);
}

void ParticleCloud::shade(const GlCamera& camera) {
    if (is_shaded_ && (is_even_ || arriving_.empty())) return;
    is_shaded_ = true;
    std::vector<std::size_t> set_of(places_.size());
    for (std::size_t set = 0, i = 0; set < set_end_.size(); ++set) {
        for (; i < set_end_[set]; ++i) set_of[i] = set;
    }
    parallel_for(count(), 256, [&](int n) {
        const auto i = static_cast<std::size_t>(n);
        const Vec3f p{places_[i][0], places_[i][1], places_[i][2]};
        const Vec3f along = camera.is_perspective ? normalize(p - camera.position) : camera.forward;
        Vec3f sum = own_[i];
        for (const Arriving& a : arriving_) {
            const Vec3f towards = a.is_infinite ? a.place : normalize(a.place - p);
            sum += a.radiance[i] * Vec3f(value(phases_[set_of[i]], dot(along, towards)));
        }
        for (int c = 0; c < 3; ++c) colors_[i][static_cast<std::size_t>(c)] = sum[c];
    });
    color_buffer_.write(std::span<const Four>(colors_));
}

}  // namespace gischt
