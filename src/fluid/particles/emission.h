// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grid/particles.h"
#include "math/keyframes.h"
#include "shape/mesh.h"

namespace gischt {

enum class SpoutKind { Point, Disc, Ball, Curve, Mesh };

// A place where particles come from.
struct SpoutParams {
    SpoutKind kind = SpoutKind::Point;
    Keyed<Vec3d> position;                    // m, centre; curves and meshes are moved by it
    Keyed<double> radius = 0.1;               // m, of a disc, ball, or the tube around a curve
    std::vector<Vec3d> points;                // m, corners of a curve
    std::string file;                         // of a mesh
    Keyed<double> rate = 1000.0;              // 1/s
    Keyed<Vec3d> direction = Vec3d(0, 0, 1);  // of the disc's normal and the cone's axis
    bool along_normal = false;  // the cone's axis is the surface's normal, the curve's tangent
    double cone_degrees = 0;    // half the opening angle
    Keyed<double> speed = 1.0;  // m/s
    double speed_spread = 0;    // share
    double inherit = 0;         // share of the place's own velocity
    Keyed<double> life = 2.0;   // s
    double life_spread = 0;     // share
    Keyed<double> particle_radius = 0.01;  // m
    double radius_spread = 0;              // share
};

// Most particles of it that are alive at once, for estimates.
double most_alive(const SpoutParams& params);

// The integral of a rate over time, and its inverse.
class RateIntegral {
  public:
    // 1/s; throws Error{Usage} for a negative rate.
    explicit RateIntegral(const Keyed<double>& rate);
    // From time 0 to `time`, exact for every kind of interpolation.
    double at(double time) const { return since_first_key(time) - offset_; }
    // When the integral reaches a value that lies between those at `from` and `to`.
    double time_of(double value, double from, double to) const;

  private:
    double since_first_key(double time) const;

    Keyed<double> rate_;
    std::vector<double> sum_;  // at the keys
    double offset_ = 0;
};

// Gives particles such that their number follows the integral of the rate evenly: particle k is
// born when the integral is k + u, u being its own random number in [0,1). The births do not depend
// on the time steps.
class Spout {
  public:
    // `mesh` is used by SpoutKind::Mesh. `index` is the place's number among those of a source:
    // particle k gets the id index 2^40 + k. Throws Error{Usage} for what gives nothing: a curve of
    // one point, a mesh without area, a direction without length.
    Spout(const SpoutParams& params, const Mesh& mesh, int index, std::uint64_t seed);

    // Appends the particles that are born in [from, to), at age 0 where they are born, and their
    // times of birth. Colour and the like are left empty.
    void emit(double from, double to, Particles& particles, std::vector<double>& birth) const;

    // How many are born in [from, to) in the mean; at most one more are.
    double births(double from, double to) const { return count_.at(to) - count_.at(from); }

  private:
    struct Spot {
        Vec3d point, normal;
    };
    Spot spot(double time, std::uint64_t key) const;
    Spot on_mesh(std::uint64_t key) const;
    Spot on_curve(std::uint64_t key) const;

    SpoutParams params_;
    RateIntegral count_;
    Mesh mesh_;
    std::vector<double> cumulative_;  // areas of triangles, or lengths of a curve's parts
    std::uint64_t first_id_, seed_;
};

}  // namespace gischt
