// SPDX-License-Identifier: Apache-2.0
#include "optics/light_rig.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "image/color.h"
#include "optics/blackbody.h"
#include "optics/local_lights.h"
#include "optics/orientation.h"

namespace gischt {
namespace {

Vec3d unit(const Vec3d& v, const LightParams& light, const char* what) {
    if (!(length(v) > 0)) {
        throw Error(ErrorKind::Usage, light.name.empty() ? "light" : "light '" + light.name + "'",
                    std::string(what) + " has no length");
    }
    return normalize(v);
}

}  // namespace

Vec3f light_tint(const LightParams& light, double time) {
    const Vec3d color = light.color.at(time);
    const double kelvin = light.temperature.at(time);
    return kelvin > 0 ? Vec3f(color) * blackbody_color(kelvin) : Vec3f(color);
}

// Makes the lights of one moment, kind by kind.
struct LightRig::Builder {
    LightRig& rig;
    double time;
    std::size_t sky_count = 0;
    std::vector<LightPtr> lights;

    template <class L>
    void add(L light, const LightParams& params, bool camera_visible) {
        light.name = params.name;
        light.group = params.group;
        light.camera_visible = camera_visible;
        lights.push_back(std::make_shared<L>(std::move(light)));
    }

    void operator()(const PointParams& p) {
        const Vec3f intensity = static_cast<float>(p.intensity.at(time)) * light_tint(p, time);
        if (max_component(intensity) > 0) add(PointLight(p.position.at(time), intensity), p, false);
    }
    void operator()(const SpotParams& p) {
        const Vec3f intensity = static_cast<float>(p.intensity.at(time)) * light_tint(p, time);
        if (!(max_component(intensity) > 0)) return;
        const Vec3d position = p.position.at(time);
        const Vec3d axis = unit(p.target.at(time) - position, p, "the way from position to target");
        const double outer = std::min(pi, radians(0.5 * p.cone_degrees.at(time)));
        add(SpotLight(position, axis, intensity, outer * (1 - p.softness), outer), p, false);
    }
    void operator()(const SunParams& p) {
        const Vec3f irradiance = static_cast<float>(p.irradiance.at(time)) * light_tint(p, time);
        if (!(max_component(irradiance) > 0)) return;
        const Vec3d towards = p.direction
                                  ? unit(p.direction->at(time), p, "the direction")
                                  : horizon_direction(p.azimuth_degrees.at(time),
                                                      p.elevation_degrees.at(time), rig.scene_up_);
        add(SunLight(towards, irradiance, radians(p.angular_diameter_degrees)), p,
            p.camera_visible);
    }
    void operator()(const ConstantParams& p) {
        const Vec3f radiance = static_cast<float>(p.radiance.at(time)) * light_tint(p, time);
        if (max_component(radiance) > 0) add(ConstantLight(radiance), p, p.camera_visible);
    }
    void operator()(const EnvironmentParams& p) {
        const Vec3f scale = static_cast<float>(p.strength.at(time)) * light_tint(p, time);
        if (!(max_component(scale) > 0)) return;
        const Vec3d up = unit(p.up ? *p.up : rig.scene_up_, p, "up");
        const Transform turn = Transform::rotation({0, 0, 1}, radians(p.rotation_degrees.at(time)));
        add(EnvironmentLight(rig.maps_.at(p.file), up_frame(up) * turn, scale), p,
            p.camera_visible);
    }
    void operator()(const AreaLightParams&) {}
    void operator()(const SkyParams& p) {
        const std::size_t index = sky_count++;
        const Vec3f scale = static_cast<float>(p.strength.at(time)) * light_tint(p, time);
        if (!(max_component(scale) > 0)) return;
        const double elevation = p.elevation_degrees.at(time), azimuth = p.azimuth_degrees.at(time);
        // The dome's sun does not sink below the end of twilight.
        const SkyState state{std::max(elevation, -18.0), p.turbidity, p.ground_albedo};
        auto& [known, sky] = rig.skies_[index];
        if (!sky.dome || known != state) {
            sky = make_sky(state);
            known = state;
        }
        const Transform turn =
            up_frame(normalize(rig.scene_up_)) * Transform::rotation({0, 0, 1}, radians(azimuth));
        add(EnvironmentLight(sky.dome, turn, scale), p, p.camera_visible);
        const Vec3f irradiance = scale * sky.sun_irradiance;
        if (!p.sun || !(max_component(irradiance) > 0)) return;
        add(SunLight(horizon_direction(azimuth, elevation, rig.scene_up_), irradiance,
                     radians(p.angular_diameter_degrees)),
            p, p.camera_visible);
    }
};

LightRig::LightRig(std::vector<AnyLightParams> lights, const Vec3d& scene_up,
                   const ImageLoader& load)
    : params_(std::move(lights)), scene_up_(scene_up) {
    for (const AnyLightParams& light : params_) {
        if (std::holds_alternative<SkyParams>(light)) skies_.emplace_back();
        const auto* environment = std::get_if<EnvironmentParams>(&light);
        if (!environment || maps_.count(environment->file)) continue;
        if (!load) {
            throw Error(ErrorKind::Usage, "light", "pictures cannot be read here",
                        "use a constant light or a sky");
        }
        maps_[environment->file] = std::make_shared<EnvironmentMap>(load(environment->file));
    }
}

std::vector<LightPtr> LightRig::at(double time) {
    Builder builder{*this, time, 0, {}};
    for (const AnyLightParams& light : params_) std::visit(builder, light);
    return std::move(builder.lights);
}

double natural_exposure(const std::vector<LightPtr>& lights, const Vec3d& point) {
    double mean = 0;
    for (const LightPtr& light : lights) {
        mean += static_cast<double>(luminance(light->mean_radiance(point)));
    }
    // Fluence is 4 pi times the mean radiance, the card's radiance albedo / pi times irradiance.
    return mean > 0 ? -std::log2(0.5 * 4 * mean) : 0;
}

}  // namespace gischt
