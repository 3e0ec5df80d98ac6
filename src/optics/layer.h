// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "math/fast_math.h"
#include "math/ray.h"

namespace gischt {

// How a density depends on the height h in metres. 1 is the density at h = 0, or the largest.
struct HeightProfile {
    enum class Kind {
        Exponential,  // exp(-h / scale)
        Tent,         // 1 at `center`, linear to 0 at `scale` above and below
    };
    Kind kind = Kind::Exponential;
    double scale = 1, center = 0;  // m

    // Along rays heights and densities are taken in float.
    float density(float h) const {
        if (kind == Kind::Exponential) return fast_exp(-h / static_cast<float>(scale));
        const float off = std::abs(h - static_cast<float>(center)) / static_cast<float>(scale);
        return std::fmax(0.0f, 1 - off);
    }
    double density(double h) const {
        if (kind == Kind::Exponential) return std::exp(-h / scale);
        return std::fmax(0.0, 1 - std::abs(h - center) / scale);
    }
};

// Matter in a layer without a grid: its density depends on the height over a plane (ground fog) or
// over a sphere (the air of a planet) alone. Above `top` there is nothing; below height 0 a flat
// layer has its density at 0, a round one nothing (there is the planet).
//
// An exponential profile ends at the latest where it has fallen to 2^-32, 22 scale heights up. What
// that leaves out, 2e-10 of the column, is less than the error of the sums.
class Layer {
  public:
    // Over the plane dot(up, x) = base, `up` being of unit length. Throws Error{Usage} unless scale
    // and top are positive.
    static Layer flat(const Vec3d& up, double base, const HeightProfile& profile,
                      double top = std::numeric_limits<double>::infinity());
    // Over a sphere. Throws Error{Usage} unless scale, top and radius are positive.
    static Layer round(const Vec3d& center, double radius, const HeightProfile& profile,
                       double top);

    bool is_round() const { return is_round_; }
    const HeightProfile& profile() const { return profile_; }
    double top() const { return top_; }
    // Box around everything; infinite for a flat layer.
    Box3d bounds() const;
    double height(const Vec3d& point) const {
        return is_round_ ? length(point - center_) - radius_ : dot(center_, point) - radius_;
    }
    double density(const Vec3d& point) const;
    double greatest_density() const;
    // Integral of the density along the ray from t_min to t_max, metres: in closed form over a
    // plane, by Gauss-Legendre in the variable in which it is smooth, within 1e-6, over a sphere.
    // May be infinite.
    double column(const Ray& ray) const;

  private:
    friend class LayerWalk;

    // A part of a ray on which the height rises or falls all the way.
    struct Piece {
        double t0, t1;
        int sign;  // of the slope of the height
    };
    // A ray seen from the layer.
    struct Path {
        Ray ray;
        double speed = 1;      // metres per t
        double nearest_t = 0;  // round: where it is nearest to the centre, and how near, m
        double nearest = 0;
        double height0 = 0, slope = 0;  // flat: height at t = 0, and its rise per t
        std::array<Piece, 2> piece{};
        int pieces = 0;
    };

    Layer(bool is_round, const Vec3d& center, double radius, const HeightProfile& profile,
          double top);
    Path path(const Ray& ray) const;
    double height_at(const Path& path, double t) const;
    // Where the ray passes a height, on the piece of that sign.
    double time_at(const Path& path, int sign, double height) const;
    // Integral of the density over `span` metres of a piece, from height h0 to h1, between which
    // the profile is smooth; metres.
    double integral(const Path& path, double h0, double h1, double span, bool is_short) const;

    bool is_round_;
    Vec3d center_;   // of the sphere; flat: the unit vector up
    double radius_;  // of the sphere; flat: the height of the plane
    HeightProfile profile_;
    double top_;
    // Heights from 0 to the top between which the density changes by a factor of at most 2 (next to
    // where a tent ends, from 1/64 to 0).
    std::vector<double> breaks_;
};

// A run of a ray through a layer: smallest, mean and largest density, and the height at t0 + t, in
// float, as entry.x + t (step.x + t step.y) / (entry.y + sqrt(entry.y^2 + t (step.x + t step.y)))
// over a sphere (entry.y being the distance from its centre) and entry.x + t step.x over a plane.
struct LayerRun {
    double t0 = 0, t1 = 0;
    double min = 0, mean = 0, max = 0;
    Vec3f entry, step;
};

// Visits a layer along a ray in runs in which the density changes little. A ray that goes on level
// or below a flat layer has a last run without end.
class LayerWalk {
  public:
    LayerWalk(const Layer& layer, const Ray& ray);
    bool next(LayerRun& run);

  private:
    void start_piece();
    void fill(LayerRun& run, double t1, double height, int band) const;

    const Layer* layer_;
    Layer::Path path_;
    int piece_ = -1, band_ = 0;  // band b: from break b to b + 1; -1: below a flat layer's base
    double t_ = 0, height_ = 0;  // where the next run begins
};

// Density of a run at t0 + t, of a layer with this profile.
inline float density_on_run(const HeightProfile& profile, bool is_round, const Vec3f& entry,
                            const Vec3f& step, float t) {
    if (!is_round) return profile.density(entry.x + t * step.x);
    // The difference of two large radii without cancellation.
    const float q = t * (step.x + t * step.y);
    const float radius = std::sqrt(std::fmax(0.0f, entry.y * entry.y + q));
    return profile.density(entry.x + q / (entry.y + radius));
}

}  // namespace gischt
