// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/particles/motion.h"

namespace gischt {
namespace {

constexpr double touching = 1e-9;  // m, below which a particle lies on a solid

// Outwards; the distance is exact, so that its slope is the normal.
Vec3d outward_normal(const Shape& shape, const Vec3d& point) {
    if (const auto* plane = std::get_if<Plane>(&shape)) return plane->normal;
    const double e = 1e-6 * std::max(1.0, max_component(abs(point)));
    Vec3d n;
    for (int a = 0; a < 3; ++a) {
        Vec3d lo = point, hi = point;
        lo[a] -= e;
        hi[a] += e;
        n[a] = signed_distance(shape, hi) - signed_distance(shape, lo);
    }
    const double l = length(n);
    return l > 0 ? n / l : Vec3d(0, 0, 1);  // the centre of a sphere has no way out of its own
}

}  // namespace

double Mover::clearance(const Vec3d& point, double radius, const Obstacle** nearest) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Obstacle& o : obstacles_) {
        const double d = signed_distance(o.shape, point) - radius;
        if (d >= least) continue;
        least = d;
        if (nearest) *nearest = &o;
    }
    return least;
}

Mover::Touch Mover::touch_at(const Vec3d& point, double radius, double seconds) const {
    const Obstacle* o = nullptr;
    clearance(point, radius, &o);
    const Vec3d velocity = o->solid->is_moving() ? o->solid->velocity_at(time_, point) : Vec3d();
    return {seconds, outward_normal(o->shape, point), velocity};
}

// Steps that cannot pass the nearest solid, but are not shorter than a sixteenth of the whole: thin
// solids are met unless the particle crosses them in less. The moment is then found by bisection,
// on the outer side.
bool Mover::first_touch(const Flight& f, double seconds, double radius, Touch& touch) const {
    const double top_speed = length(f.start.velocity) + seconds * length(f.drive);
    const double least = seconds / 16;
    double s = 0, d = clearance(f.start.position, radius, nullptr);
    if (d <= touching) {
        touch = touch_at(f.start.position, radius, 0);
        if (dot(f.start.velocity - touch.velocity, touch.normal) <= 0) return true;
    }
    while (s < seconds) {
        if (d > top_speed * (seconds - s)) return false;
        double inside = std::min(seconds, s + std::max(least, top_speed > 0 ? d / top_speed : 0));
        d = clearance(f.at(inside).position, radius, nullptr);
        if (d < 0) {
            double outside = s;
            for (int i = 0; i < 50; ++i) {
                const double middle = 0.5 * (outside + inside);
                (clearance(f.at(middle).position, radius, nullptr) < 0 ? inside : outside) = middle;
            }
            touch = touch_at(f.at(outside).position, radius, outside);
            return true;
        }
        s = inside;
    }
    return false;
}

// What lies inside of a solid, because that moved or something was born there, gets to its surface,
// and does not move deeper.
void Mover::push_out(PointMotion& p, double radius) const {
    if (obstacles_.empty()) return;
    for (int i = 0; i < 4; ++i) {
        const double d = clearance(p.position, radius, nullptr);
        if (d >= -touching) return;
        const Touch touch = touch_at(p.position, radius, 0);
        p.position -= d * touch.normal;
        rebound(p, touch);
    }
}

void Mover::rebound(PointMotion& p, const Touch& touch) const {
    const Vec3d v = p.velocity - touch.velocity;
    const double approach = -dot(v, touch.normal);
    if (approach <= 0) return;
    // Coulomb: the tangential impulse is friction times the normal one, and stops at most.
    const Vec3d along = v + approach * touch.normal;
    const double e = params_.contact.restitution, speed = length(along),
                 loss = params_.contact.friction * (1 + e) * approach;
    const double kept = speed > loss ? 1 - loss / speed : 0;
    p.velocity = touch.velocity + kept * along + (e * approach) * touch.normal;
}

// Along the tangent, slowed by the friction of what presses on the solid.
PointMotion Mover::slide(const Flight& f, const Touch& touch, double seconds) const {
    const auto tangential = [&](const Vec3d& v) { return v - dot(v, touch.normal) * touch.normal; };
    Flight on_solid = f;
    on_solid.start.velocity = tangential(f.start.velocity - touch.velocity);
    on_solid.drive = tangential(f.drive - f.k * touch.velocity);
    PointMotion p = on_solid.at(seconds);
    const Vec3d force = f.drive - f.k * touch.velocity;
    const double press = std::max(0.0, -dot(force, touch.normal)), speed = length(p.velocity),
                 loss = params_.contact.friction * press * seconds;
    const double kept = speed > loss ? 1 - loss / speed : 0;
    const Vec3d begin = on_solid.start.velocity, end = kept * p.velocity;
    p.position = f.start.position + (0.5 * seconds) * (begin + end) + seconds * touch.velocity;
    p.velocity = touch.velocity + end;
    return p;
}

}  // namespace gischt
