// SPDX-License-Identifier: Apache-2.0
#include "render/bdpt/light_choice.h"

#include <algorithm>

#include "image/color.h"

namespace gischt {
namespace {

using Kind = EmittedLight::Kind;

LightEnd end_at(Kind kind, const Vec3d& place, const Vec3d& from) {
    LightEnd end;
    end.kind = kind;
    const Vec3d way = place - from;
    end.distance = length(way);
    end.direction = way / end.distance;
    return end;
}

}  // namespace

LightEnd surface_end(const BdptScene& scene, const SurfaceHit& hit, const Vec3d& from) {
    LightEnd end = end_at(Kind::Surface, hit.point, from);
    end.facing = std::abs(dot(end.direction, hit.normal));
    const SurfaceLight* light = scene.path.surface_light[static_cast<std::size_t>(hit.surface)];
    if (!light) return end;
    end.sampled =
        static_cast<double>(scene.path.local_share(*light, from) * light->pdf_of_hit(from, hit));
    if (scene.emission) end.emitted = scene.emission->of_surface(hit, -end.direction);
    return end;
}

LightEnd far_end(const BdptScene& scene, const Light& light, const Vec3d& from,
                 const Vec3d& direction) {
    LightEnd end;
    end.kind = Kind::Infinity;
    end.direction = direction;
    end.is_delta = light.is_delta();
    end.sampled = scene.far_share(light) *
                  (end.is_delta ? 1 : static_cast<double>(light.pdf(from, direction)));
    const int source = scene.source_of(&light);
    if (scene.emission && source >= 0 && scene.is_in_reach(from, -direction)) {
        end.emitted = scene.emission->of_infinity(source, -direction);
        if (!end.is_delta && !(end.emitted.direction > 0)) end.emitted = {};
    }
    return end;
}

LightEnd glow_end(const BdptScene& scene, const Medium& medium, const Vec3d& point,
                  const Vec3d& from) {
    LightEnd end = end_at(Kind::Volume, point, from);
    if (const int index = scene.glow_index(&medium); index >= 0) {
        end.sampled = static_cast<double>(scene.glow.pdf(from, index, point));
    }
    const int source = scene.source_of(&medium);
    if (scene.emission && source >= 0) {
        end.emitted = scene.emission->of_medium(source, point);
        if (!(end.emitted.place > 0)) end.emitted = {};
    }
    return end;
}

LightEnd point_end(const BdptScene& scene, const Light& light, const Vec3d& place,
                   const Vec3d& from) {
    LightEnd end = end_at(Kind::Point, place, from);
    end.is_delta = true;
    end.sampled = static_cast<double>(scene.path.local_share(light, from));
    const int source = scene.source_of(&light);
    if (scene.emission && source >= 0) {
        end.emitted = scene.emission->of_point(source, -end.direction);
    }
    return end;
}

LightEnd light_end_of(const BdptScene& scene, const PathVertex& light, const Vec3d& from) {
    const Light* source = scene.emission->sources()[static_cast<std::size_t>(light.source)].light;
    switch (light.light) {
        case Kind::Surface:
            return surface_end(scene, *light.hit, from);
        case Kind::Infinity:
            return far_end(scene, *source, from, light.back);
        case Kind::Volume:
            return glow_end(scene, *light.medium, light.point, from);
        default:
            return point_end(scene, *source, light.point, from);
    }
}

DrawnLight draw_local(const BdptScene& scene, const Vec3d& point, RandomStream& random) {
    const float u = random.next();
    const Vec2f place = random.two();
    float total = 0;
    for (const auto& d : scene.path.local) total += luminance(d.light->mean_radiance(point));
    constexpr float at_a_light = 1e15f;  // nearer than some 1e-8 m, where all sums overflow
    if (!(total > 0) || total > at_a_light) return {};
    float left = u * total;
    DrawnLight drawn;
    for (const auto& d : scene.path.local) {
        const float here = luminance(d.light->mean_radiance(point));
        if (here > 0) {
            drawn.light = d.light;
            drawn.share = here / total;
        }
        left -= here;
        if (left < 0) break;
    }
    drawn.sample = drawn.light->sample(point, place);
    return drawn;
}

DrawnLight draw_broad(const BdptScene& scene, const Vec3d& point, RandomStream& random) {
    const auto n = static_cast<float>(scene.path.broad.size());
    const auto pick = static_cast<std::size_t>(random.next() * n);
    const auto& d = scene.path.broad[std::min(pick, scene.path.broad.size() - 1)];
    DrawnLight drawn{d.light, nullptr, d.light->sample(point, random.two()), 1 / n};
    if (!(drawn.sample.pdf > 0)) drawn.light = nullptr;
    return drawn;
}

DrawnLight draw_glow(const BdptScene& scene, const Vec3d& point, RandomStream& random) {
    const float choice = random.next();
    const Vec2f place = random.two();
    const EmissionSample s = scene.glow.sample(point, choice, {place.x, place.y, random.next()});
    if (!(s.pdf > 0)) return {};
    const Medium* medium = scene.glowing[static_cast<std::size_t>(s.medium)];
    const Vec3d way = s.point - point;
    const double d2 = dot(way, way), d = std::sqrt(d2);
    if (!(d > 0)) return {};
    // Where a surface is filled with something else, this medium is not.
    if (scene.path.has_interiors) {
        const InteriorStack inside(scene.view.surfaces, s.point);
        const bool is_filling = scene.path.media.end() ==
                                std::find(scene.path.media.begin(), scene.path.media.end(), medium);
        if (is_filling ? inside.medium() != medium : inside.surface() >= 0) return {};
    }
    DrawnLight drawn;
    drawn.medium = medium;
    drawn.share = 1;
    drawn.sample.direction = way / d;
    drawn.sample.distance = d;
    drawn.sample.weight =
        medium->at(s.point).emission * static_cast<float>(1 / (static_cast<double>(s.pdf) * d2));
    return drawn;
}

}  // namespace gischt
