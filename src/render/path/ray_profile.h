// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/path/media_walk.h"

namespace gischt {

// A point of a ray at which light may be scattered towards its origin.
struct ProfilePoint {
    double t = 0;
    std::size_t medium = 0;  // the one that scatters
    Vec3f weight;            // transmittance * scattering / density of the point
};

// The optical depth along a ray through media, without error but rounding: pieces in which every
// density is a cubic polynomial of t, integrated by two Gauss points each. Gives transmittances,
// and points in proportion to the extinction that is seen. Keeps its memory from ray to ray; one
// per thread.
class RayProfile {
  public:
    // The ray has unit direction. Stops at an optical depth of 24 in the clearest channel.
    void trace(std::span<const Medium* const> media, const Ray& ray, bool is_grey,
               std::int64_t& lookups);

    bool is_empty() const { return pieces_.empty(); }
    // Where it begins and ends along the ray; not when it is empty.
    double begin() const { return pieces_.front().t0; }
    double end() const { return pieces_.back().t0 + static_cast<double>(pieces_.back().length); }
    // Optical depth per channel of all of it.
    const Vec3f& depth() const { return depth_; }

    // The same up to t, the extinction being taken as constant in each piece; without look-ups.
    Vec3f depth_to(double t) const;
    // The t before which the optical depth of the clearest channel stays below `depth`.
    double end_at(float depth) const;

    // Appends n points with a density in proportion to the mean over the channels that have an
    // extinction of transmittance times extinction (constant extinction taken in each piece), at
    // the stratified places (i + u) / n. The sum over the points of weight * f estimates the
    // integral of transmittance
    // * scattering * f. `choose` in [0, 1) picks among overlapping media.
    void points(int n, float u, float choose, std::vector<ProfilePoint>& out,
                std::int64_t& lookups) const;
    // Density of these points at t, 1/m.
    float density(double t) const;
    // The point at t with weight transmittance * scattering / pdf.
    ProfilePoint at(double t, float pdf, float choose, std::int64_t& lookups) const;

    // Integral of transmittance times emission, one random place per piece: W/(m^2 sr).
    Vec3f emission(float u, std::int64_t& lookups) const;

  private:
    struct Run {
        double t0 = 0, t1 = 0;
        std::size_t first = 0, count = 0;  // of active_
    };
    struct Piece {
        double t0 = 0;
        float length = 0;
        std::uint32_t run = 0;
        Vec3f depth;       // before it
        Vec3f extinction;  // mean, 1/m
        int halvings = 0;  // see add_thick()
    };
    static bool is_thick(const Piece& p) { return p.length * max_component(p.extinction) > 1; }
    std::span<const ActiveMedium> active(const Piece& piece) const {
        const Run& run = runs_[piece.run];
        return {active_.data() + run.first, run.count};
    }
    void add_run(const MediaRun& run, std::int64_t& lookups);
    void add_thick(std::size_t first, std::int64_t& lookups);
    Vec3f mean_extinction(const Piece& p, std::int64_t& lookups) const;
    const Piece* find(double t) const;
    ProfilePoint make_point(const Piece& piece, double t, float pdf, float choose,
                            std::int64_t& lookups) const;
    float density_in(const Piece& piece, float s) const;

    bool is_grey_ = true;
    Vec3f depth_;
    std::array<int, 3> channel_{};  // those with an extinction; in grey media one for all
    int channels_ = 0;              // their number
    std::vector<Run> runs_;
    std::vector<ActiveMedium> active_;
    std::vector<Piece> pieces_, thick_;
    std::vector<float> edges_, t_, densities_;
};

}  // namespace gischt
