// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/strategy_weights.h"

namespace gischt {

double power_heuristic(double ratio) {
    return ratio * ratio;
}

double strategies_before(const BdptScene& scene, std::span<const PathVertex> path,
                         double back_density, bool is_end) {
    const PathVertex& v = path.back();
    if (path.size() == 1) {
        return v.is_light() && v.light != EmittedLight::Kind::Point && !v.is_delta ? 1 : 0;
    }
    const PathVertex& u = path[path.size() - 2];
    const bool v_meets = is_end || !v.is_delta;
    double sum = 0;
    if (u.is_light()) {
        if (v_meets) sum = power_heuristic(v.sampled / v.through);
    } else if (v_meets && (u.kind == PathVertex::Kind::Camera || !u.is_delta)) {
        sum = power_heuristic(1 / v.through);
    }
    if (v.earlier == 0) return sum;
    double by_other = back_density;  // of a direction to a light at infinity
    if (!u.is_light() || u.light != EmittedLight::Kind::Infinity) {
        const Vec3d way = v.point - u.point;
        const double d2 = dot(way, way);
        by_other *= u.facing(way / std::sqrt(d2)) / d2;
        if (u.is_light() && u.medium) by_other *= scene.glow_rate;
    }
    return sum + power_heuristic(by_other / u.density) * v.earlier;
}

// The units: that of `found`, made a density over the light by the distance and the cosine.
LightEndStrategies strategies_at(const BdptScene& scene, std::span<const PathVertex> camera,
                                 const LightEnd& light, double found, double through,
                                 double back_density, bool is_end) {
    using Kind = EmittedLight::Kind;
    const PathVertex& v = camera.back();
    const bool is_far = light.kind == Kind::Infinity, is_glow = light.kind == Kind::Volume;
    const double d2 = is_far ? 1 : light.distance * light.distance;
    const double to_place = is_far || light.kind == Kind::Point ? 1 : light.facing / d2;
    LightEndStrategies all;
    if (!light.is_delta) {
        all.found = power_heuristic(found * to_place * (is_glow ? scene.glow_rate : 1));
    }
    // What the camera sees itself has only the camera's path.
    if (v.kind == PathVertex::Kind::Camera) return all;
    if (is_end || !v.is_delta) {
        all.sampled = power_heuristic(light.sampled * (is_glow ? 1 : to_place) / through);
    }
    const LightEmission::Densities& e = light.emitted;
    if (!(e.choice > 0)) return all;
    const auto or_one = [](float density) {
        return density > 0 ? static_cast<double>(density) : 1.0;
    };
    // A light at infinity has its direction drawn first and then a place across it.
    const double start = static_cast<double>(e.choice) * or_one(is_far ? e.direction : e.place);
    const double next =
        static_cast<double>(is_far ? e.place : e.direction) * v.facing(light.direction) / d2;
    if (!(next > 0)) return all;
    all.rest = power_heuristic(start * next / v.density) *
               strategies_before(scene, camera, back_density, is_end);
    return all;
}

}  // namespace gischt
