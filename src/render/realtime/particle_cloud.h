// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "render/realtime/depth_sort.h"
#include "render/realtime/lit_grid.h"

namespace gischt {

enum class ParticleShading {
    Lit,    // scatter the light that reaches them through the medium that they make
    Glow,   // black bodies of their temperature
    Plain,  // their own colour, whatever the light
};

struct ParticleShadingParams {
    ParticleShading shading = ParticleShading::Lit;
    double brightness = 1;  // factor on what they radiate
    double opacity = 1;     // factor on theirs
};

// The keys shading, brightness, opacity.
const Table<ParticleShadingParams>& particle_shading_table();

// The particles of a view's frames as buffers, each four floats per particle, in the order of the
// frames and their sets:
//   places   x, y, z relative to origin() in metres, and the radius
//   motions  velocity in m/s, and age / life in [0,1]
//   chances  two random numbers in [0,1) and two unused ones, made of the particle's id
//   colors   radiance towards the camera in W/(m^2 sr) where it is fully covered, and opacity
class ParticleCloud {
  public:
    explicit ParticleCloud(GlDevice& device) : device_(device) {}

    // Throws Error{Usage}, with the method's name, where there are no particle sets at all, and
    // for `glow` without temperatures.
    void upload(const View& view, const LitGrid& grid, const ParticleShadingParams& params,
                std::string_view method);
    // The colours for a camera: they depend on it where a phase function is not even.
    void shade(const GlCamera& camera);

    int count() const { return static_cast<int>(places_.size()); }
    // The largest radius as the picture shows it; infinite for one that the eye is in.
    double largest_in_pixels(const GlCamera& camera) const;
    const Vec3d& origin() const { return origin_; }
    double reach() const { return reach_; }
    const GlBuffer& places() const { return place_buffer_; }
    const GlBuffer& motions() const { return motion_buffer_; }
    const GlBuffer& chances() const { return chance_buffer_; }
    const GlBuffer& colors() const { return color_buffer_; }

  private:
    using Four = std::array<float, 4>;
    // Light that reaches every particle from one direction, times the albedo.
    struct Arriving {
        bool is_infinite = false;
        Vec3f place;                  // towards it, or where it is, relative to the origin
        std::vector<Vec3f> radiance;  // W/m^2
    };
    void add(const Particles& particles);
    void light(const View& view, const LitGrid& grid);

    GlDevice& device_;
    Vec3d origin_;
    double reach_ = 1;
    std::vector<Four> places_, motions_, chances_, colors_;
    std::vector<Vec3f> own_;  // radiance that does not depend on the camera
    std::vector<std::size_t> medium_of_set_, set_end_;
    std::vector<PhaseFunction> phases_;  // by set
    std::vector<Arriving> arriving_;
    bool is_shaded_ = false, is_even_ = true;
    GlBuffer place_buffer_, motion_buffer_, chance_buffer_, color_buffer_;
};

}  // namespace gischt
