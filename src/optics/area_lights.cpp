// SPDX-License-Identifier: Apache-2.0
#include "optics/area_lights.h"

#include "base/error.h"
#include "base/units.h"
#include "optics/light_rig.h"

namespace gischt {
namespace {

struct LampAt {
    double time;
    using Lamp = std::optional<SurfaceParams>;

    Lamp operator()(const RectLightParams& p) const {
        RectSurface s;
        place(s, p);
        s.size = p.size;
        s.roll_degrees = p.roll_degrees;
        return finished(std::move(s), p, p.size.x * p.size.y * (p.two_sided ? 2 : 1));
    }
    Lamp operator()(const DiscLightParams& p) const {
        DiscSurface s;
        place(s, p);
        s.radius = p.radius;
        return finished(std::move(s), p, pi * p.radius * p.radius * (p.two_sided ? 2 : 1));
    }
    Lamp operator()(const SphereLightParams& p) const {
        SphereSurface s;
        s.center = p.position;
        s.radius = p.radius;
        return finished(std::move(s), p, 4 * pi * p.radius * p.radius);
    }
    Lamp operator()(const LightParams&) const { return std::nullopt; }

    template <class S, class P>
    static void place(S& s, const P& p) {
        s.center = p.position;
        s.target = p.target;
        s.two_sided = p.two_sided;
    }
    // `area`: of all that shines. A Lambert emitter of radiance L gives off pi L per area.
    template <class S>
    Lamp finished(S s, const AreaLightParams& p, double area) const {
        const double radiance = p.power ? p.power->at(time) / (pi * area) : p.radiance.at(time);
        const Vec3d emission = radiance * Vec3d(light_tint(p, time));
        if (!(max_component(emission) > 0)) return std::nullopt;
        s.name = p.name;
        s.material.albedo = Vec3d(0);
        s.material.emission = Keyed<Vec3d>(emission);
        s.material.camera_visible = p.camera_visible;
        return SurfaceParams(std::move(s));
    }
};

}  // namespace

std::optional<SurfaceParams> lamp_surface(const AnyLightParams& light, double time) {
    return std::visit(LampAt{time}, light);
}

}  // namespace gischt
