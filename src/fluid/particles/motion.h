// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fluid/particles/air.h"
#include "fluid/solid.h"
#include "shape/shape.h"

namespace gischt {

// A point that pulls (or, below 0, pushes): acceleration strength d / (|d|^2 + core^2)^(3/2), d
// being the way to it (Plummer 1911).
struct AttractorParams {
    Keyed<Vec3d> position;         // m
    Keyed<double> strength = 1.0;  // m^3/s^2
    double core = 0.1;             // m
};

enum class ParticleMotion { Inertial, Tracer };
enum class ContactKind { Bounce, Vanish, Pass };

struct ContactParams {
    ContactKind kind = ContactKind::Bounce;
    double restitution = 0.4;  // speed after over speed before, along the normal
    double friction = 0.3;     // Coulomb's
};

// What moves particles.
struct MotionParams {
    ParticleMotion kind = ParticleMotion::Inertial;
    double linear_drag = 0;     // 1/s: a = -linear_drag (v - u), u the air's velocity
    double quadratic_drag = 0;  // 1/m: a = -quadratic_drag |v - u| (v - u)
    std::vector<AttractorParams> attractors;
    ContactParams contact;
};

struct PointMotion {
    Vec3d position, velocity;  // m, m/s
};

// Motion under a constant acceleration and a drag rate k towards an air of constant velocity;
// `drive` is the acceleration plus k times that velocity. Exact, for every k >= 0 and time.
struct Flight {
    PointMotion start;
    Vec3d drive;   // m/s^2
    double k = 0;  // 1/s

    PointMotion at(double seconds) const;
};

// A solid at one moment.
struct Obstacle {
    Shape shape;
    const SolidParams* solid;
};

// Moves particles one by one. Immutable but for begin_step().
class Mover {
  public:
    // `air` and `solids` must outlive it. Throws Error{Usage} on negative drag and solids without
    // extent.
    Mover(const MotionParams& params, const Vec3d& gravity, const Air& air,
          const std::vector<SolidParams>& solids);

    // Takes the solids where they are at the end of a step.
    void begin_step(double end_time);
    // Moves a particle of that radius from `time` on for `seconds`: second order in them (inertial,
    // where nothing but gravity, an even wind and linear drag acts exact), third order (tracer;
    // Ralston 1962). Stable for any length. False where it vanished at a solid, at the contact.
    bool advance(PointMotion& p, double radius, double time, double seconds) const;

  private:
    struct Touch {
        double seconds = 0;
        Vec3d normal, velocity;  // of the solid
    };
    Vec3d acceleration(const Vec3d& point, double time) const;
    Flight flight(const PointMotion& p, double time, double seconds) const;
    PointMotion carried_by_air(const PointMotion& p, double time, double seconds) const;
    double clearance(const Vec3d& point, double radius, const Obstacle** nearest) const;
    bool first_touch(const Flight& f, double seconds, double radius, Touch& touch) const;
    Touch touch_at(const Vec3d& point, double radius, double seconds) const;
    void push_out(PointMotion& p, double radius) const;
    void rebound(PointMotion& p, const Touch& touch) const;
    PointMotion slide(const Flight& f, const Touch& touch, double seconds) const;

    MotionParams params_;
    Vec3d gravity_;
    const Air& air_;
    const std::vector<SolidParams>& solids_;
    std::vector<Obstacle> obstacles_;
    double time_ = 0;
};

}  // namespace gischt
