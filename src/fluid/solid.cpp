// SPDX-License-Identifier: Apache-2.0
#include "fluid/solid.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace gischt {

const Table<SolidParams>& solid_table() {
    using P = SolidParams;
    static const Table<P> table =
        Table<P>("solid", "A rigid body that the fluid flows around")
            .choice("shape", &P::kind,
                    {{"sphere", SolidKind::Sphere},
                     {"box", SolidKind::Box},
                     {"plane", SolidKind::Plane, "everything below a plane"}},
                    {.help = "What it looks like"})
            .add("position", &P::position,
                 {.unit = "m", .help = "Centre; of a plane any point of it"})
            .add("radius", &P::radius,
                 {.unit = "m", .help = "Radius of a sphere", .min = 0, .min_open = true})
            .add("size", &P::size,
                 {.unit = "m", .help = "Edges of a box", .min = 0, .min_open = true})
            .add("normal", &P::normal, {.help = "Of a plane, towards the fluid"})
            .add("rotation", &P::rotation,
                 {.unit = "degree", .help = "Turns the body: axis times angle"})
            .add("temperature", &P::temperature,
                 {.unit = "K", .help = "Of its surface; unset: insulated", .min = 0})
            .check([](const P& p, const Fail& fail) {
                if (!(length(p.normal) > 0)) fail("normal", "must have a length");
            });
    return table;
}

void check_solid(const SolidParams& p) {
    const auto bad = [](const char* what) {
        throw Error(ErrorKind::Usage, "solid", what, "give what is larger than 0");
    };
    for (const double r : p.radius.v) {
        if (p.kind == SolidKind::Sphere && !(r > 0)) bad("a radius is not positive");
    }
    for (const Vec3d& s : p.size.v) {
        if (p.kind == SolidKind::Box && !(min_component(s) > 0)) bad("an edge is not positive");
    }
    if (p.kind == SolidKind::Plane && !(length(p.normal) > 0)) bad("a normal has no length");
    for (const double f : p.scale.v) {
        if (p.kind == SolidKind::Mesh && !(f > 0)) bad("a scale is not positive");
    }
    if (p.kind == SolidKind::Mesh && !p.mesh) bad("a mesh is missing");
    for (const double t : p.temperature ? p.temperature->v : std::vector<double>{}) {
        if (!(t >= 0) || !std::isfinite(t)) bad("a temperature is negative");
    }
}

Transform SolidParams::rotation_at(double time) const {
    const Vec3d turn = rotation.at(time);
    const double angle = length(turn);
    return angle == 0 ? Transform{} : Transform::rotation(turn / angle, radians(angle));
}

Shape SolidParams::shape_at(double time) const {
    const Vec3d at = position.at(time);
    switch (kind) {
        case SolidKind::Sphere:
            return Sphere{at, radius.at(time)};
        case SolidKind::Box:
            return SolidBox{at, size.at(time), rotation_at(time)};
        case SolidKind::Mesh:
            throw Error(ErrorKind::Usage, "solid", "a mesh is no simple shape",
                        "particles meet spheres, boxes and planes");
        case SolidKind::Plane:
            break;
    }
    return Plane{at, rotation_at(time).vector(normalize(normal))};
}

Vec3d SolidParams::velocity_at(double time, const Vec3d& point) const {
    constexpr double e = 1e-3;  // s, half the span of the central difference, as in Keyed::rate()
    const Transform now = rotation_at(time), before = rotation_at(time - e),
                    after = rotation_at(time + e);
    const Vec3d arm = point - position.at(time);
    // The arm as the body's own axes see it, carried along by their motion.
    const Vec3d own = now.inverse().vector(arm);
    Vec3d v = position.rate(time) + (after.vector(own) - before.vector(own)) * (0.5 / e);
    const double reach = length(arm);
    if (kind == SolidKind::Sphere && reach > 0) {
        v += arm * (radius.rate(time) / reach);
    }
    if (kind == SolidKind::Mesh) v += arm * (scale.rate(time) / scale.at(time));
    return v;
}

static Transform mesh_to_world(const SolidParams& p, double time) {
    Transform t = p.rotation_at(time) * Transform::scale_translate(p.scale.at(time), {});
    t.translation = p.position.at(time);
    return t;
}

PlacedSolid::PlacedSolid(const SolidParams& p, double time) {
    if (p.kind != SolidKind::Mesh) {
        shape_ = p.shape_at(time);
        return;
    }
    mesh_ = p.mesh;
    to_world_ = mesh_to_world(p, time);
    to_mesh_ = to_world_.inverse();
    scale_ = p.scale.at(time);
}

double PlacedSolid::signed_distance(const Vec3d& p) const {
    if (!mesh_) return gischt::signed_distance(shape_, p);
    const Vec3d own = to_mesh_.point(p);
    const double distance = scale_ * mesh_->distance(own);
    return mesh_->is_inside(own) ? -distance : distance;
}

bool PlacedSolid::is_inside(const Vec3d& p) const {
    if (!mesh_) return gischt::signed_distance(shape_, p) < 0;
    return mesh_->is_inside(to_mesh_.point(p));
}

Box3d PlacedSolid::bounds() const {
    return mesh_ ? to_world_.bounds(mesh_->bounds()) : gischt::bounds(shape_);
}

}  // namespace gischt
