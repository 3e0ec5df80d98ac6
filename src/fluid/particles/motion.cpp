// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/motion.h"

#include <cmath>

#include "base/error.h"

namespace gischt {

PointMotion Flight::at(double seconds) const {
    // phi1 = (1 - e^-z) / z and phi2 = (1 - phi1) / z; near 0 by their series, whose next term is
    // below the rounding of the closed form there.
    const double z = k * seconds, decay = std::exp(-z);
    double phi1, phi2;
    if (z < 1e-3) {
        phi1 = 1 - z * (1.0 / 2 - z * (1.0 / 6 - z * (1.0 / 24 - z / 120)));
        phi2 = 1.0 / 2 - z * (1.0 / 6 - z * (1.0 / 24 - z * (1.0 / 120 - z / 720)));
    } else {
        phi1 = -std::expm1(-z) / z;
        phi2 = (1 - phi1) / z;
    }
    const Vec3d& v = start.velocity;
    return {start.position + (seconds * phi1) * v + (seconds * seconds * phi2) * drive,
            decay * v + (seconds * phi1) * drive};
}

Mover::Mover(const MotionParams& params, const Vec3d& gravity, const Air& air,
             const std::vector<SolidParams>& solids)
    : params_(params), gravity_(gravity), air_(air), solids_(solids) {
    if (!(params.linear_drag >= 0 && params.quadratic_drag >= 0)) {
        throw Error(ErrorKind::Usage, "particles", "a drag is negative", "give 0 for none");
    }
    for (const SolidParams& s : solids) check_solid(s);
}

void Mover::begin_step(double end_time) {
    time_ = end_time;
    obstacles_.clear();
    if (params_.contact.kind == ContactKind::Pass) return;
    for (const SolidParams& s : solids_) obstacles_.push_back({s.shape_at(end_time), &s});
}

Vec3d Mover::acceleration(const Vec3d& point, double time) const {
    Vec3d a = gravity_;
    for (const AttractorParams& p : params_.attractors) {
        const Vec3d d = p.position.at(time) - point;
        const double r2 = dot(d, d) + p.core * p.core;
        a += (p.strength.at(time) / (r2 * std::sqrt(r2))) * d;
    }
    return a;
}

// The forces are those in the middle of the step, where the velocity alone leads: that is off by
// the second order of the step, and costs one look at the air.
Flight Mover::flight(const PointMotion& p, double time, double seconds) const {
    const double linear = params_.linear_drag, quadratic = params_.quadratic_drag;
    const double half = 0.5 * seconds;
    const Vec3d middle = p.position + half * p.velocity;
    const Vec3d a = acceleration(middle, time + half);
    if (linear == 0 && quadratic == 0) return {p, a, 0};
    // The speed against the air in the middle of the step, by a backward Euler step up to there:
    // s (1 + (linear + quadratic s) half) = |w + a half|. It is the terminal one where that has
    // been reached, and for every long step.
    const Vec3d u = air_.velocity(middle, time + half);
    const double b = length(p.velocity - u + half * a), c = 1 + linear * half;
    const double s = 2 * b / (c + std::sqrt(c * c + 4 * quadratic * half * b));
    const double k = linear + quadratic * s;
    return {p, a + k * u, k};
}

PointMotion Mover::carried_by_air(const PointMotion& p, double time, double seconds) const {
    const auto u = [&](const Vec3d& x, double share) {
        return air_.velocity(x, time + share * seconds);
    };
    const Vec3d k1 = u(p.position, 0), k2 = u(p.position + (0.5 * seconds) * k1, 0.5),
                k3 = u(p.position + (0.75 * seconds) * k2, 0.75);
    const Vec3d mean = (1.0 / 9) * (2.0 * k1 + 3.0 * k2 + 4.0 * k3);
    return {p.position + seconds * mean, mean};
}

bool Mover::advance(PointMotion& p, double radius, double time, double seconds) const {
    push_out(p, radius);
    Flight f;
    if (params_.kind == ParticleMotion::Tracer) {
        f = {{p.position, carried_by_air(p, time, seconds).velocity}, {}, 0};
    } else {
        f = flight(p, time, seconds);
    }
    // From contact to contact; what bounces more often in one step lies still or slides.
    constexpr int most_contacts = 8;
    double rest = seconds;
    for (int contact = 0; !obstacles_.empty(); ++contact) {
        Touch touch;
        if (!first_touch(f, rest, radius, touch)) break;
        p = f.at(touch.seconds);
        rest -= touch.seconds;
        if (params_.contact.kind == ContactKind::Vanish) return false;
        rebound(p, touch);
        f.start = p;
        // A leap shorter than an eighth of what is left counts as lying.
        const double away = dot(p.velocity - touch.velocity, touch.normal),
                     back = -dot(f.drive - f.k * p.velocity, touch.normal);
        if (contact + 1 == most_contacts || 2 * away < back * rest / 8 ||
            params_.kind == ParticleMotion::Tracer) {
            p = slide(f, touch, rest);
            push_out(p, radius);
            return true;
        }
    }
    p = f.at(rest);
    return true;
}

}  // namespace gischt
