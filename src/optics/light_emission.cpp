// SPDX-License-Identifier: Apache-2.0
#include "optics/light_emission.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "math/sobol.h"
#include "optics/interior.h"
#include "optics/local_lights.h"
#include "optics/material.h"

namespace gischt {
namespace {

using Kind = EmittedLight::Kind;

double mean_channel(const Vec3f& v) {
    return (static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z)) / 3;
}

Box3d target_of(const Box3d& reach, const std::optional<Box3d>& aim) {
    return aim ? intersection(*aim, reach) : reach;
}

Vec3d on_sphere(Vec2f u) {
    const double z = 1 - 2 * static_cast<double>(u.x), turn = 2 * pi * static_cast<double>(u.y);
    const double sine = std::sqrt(std::max(0.0, 1 - z * z));
    return {sine * std::cos(turn), sine * std::sin(turn), z};
}

// Whether anybody may see what the inner side of a closed surface lights.
bool is_open_to_view(const View& view, const SurfaceLight& light) {
    const SurfaceInfo& info = view.surfaces.info(light.surface());
    if (info.material == MaterialKind::None || info.material == MaterialKind::Dielectric)
        return true;
    if (!info.camera_visible) return true;
    const Vec3d eye = view.camera.ray(0.5 * view.width(), 0.5 * view.height()).origin;
    const auto ball = light.place();
    return ball && length(eye - ball->center) <= ball->radius;
}

}  // namespace

LightEmission::LightEmission(const View& view, const Box3d& reach, const std::optional<Box3d>& aim,
                             Job& job)
    : view_(view),
      target_(target_of(reach, aim)),
      retreat_(1.01 * length(reach.size())),
      cumulative_{0},
      of_surface_(static_cast<std::size_t>(view.surfaces.size()), -1) {
    for (int i = 0; i < view.surfaces.size(); ++i) {
        has_interiors_ = has_interiors_ || view.surfaces.info(i).has_interior;
    }
    for (std::size_t i = 0; i < view.lights.size(); ++i) {
        add_light(*view.lights[i], static_cast<int>(i));
    }
    add_surfaces();
    add_media();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        if (!(sources_[i].power > 0)) sources_[i].power = mean_power(i, job);
        cumulative_.push_back(cumulative_.back() + sources_[i].power);
    }
}

void LightEmission::add(Source source, Detail detail) {
    sources_.push_back(source);
    details_.push_back(std::move(detail));
}

void LightEmission::add_light(const Light& light, int index) {
    Source source{Kind::Infinity, &light, index, nullptr, 0};
    Detail detail;
    if (!light.is_infinite()) {
        source.kind = Kind::Point;
        detail.position = light.place()->center;
        if (const auto* spot = dynamic_cast<const SpotLight*>(&light)) {
            double seen = 4 * pi;
            if (!target_.surrounds(detail.position)) {
                const Vec3d middle = 0.5 * (target_.box().lo + target_.box().hi);
                seen =
                    1 / target_.direction_pdf(detail.position, normalize(middle - detail.position));
            }
            detail.is_cone = spot->solid_angle() < seen;
        }
    }
    add(source, detail);
}

void LightEmission::add_surfaces() {
    for (const auto& light : view_.surfaces.lights()) {
        const SurfaceInfo& info = view_.surfaces.info(light->surface());
        Detail detail;
        detail.surface = light.get();
        const bool both = light->is_closed() ? is_open_to_view(view_, *light) : info.two_sided;
        detail.sides = both ? 2 : 1;
        of_surface_[static_cast<std::size_t>(light->surface())] = static_cast<int>(sources_.size());
        add({Kind::Surface, light.get(), -1, nullptr,
             pi * light->area() * detail.sides * mean_channel(light->emission())},
            detail);
    }
}

void LightEmission::add_media() {
    for (const auto& medium : view_.media) {
        if (!medium->is_emissive()) continue;
        Detail detail;
        detail.glow = std::make_shared<const EmissionSampler>(std::span(&medium, 1));
        if (detail.glow->is_empty() || !(detail.glow->power() > 0)) continue;
        const Box3d box = medium->bounds();
        detail.far = box.hi + 1e4 * box.size();
        add({Kind::Volume, nullptr, -1, medium.get(), 4 * pi * detail.glow->power()}, detail);
    }
}

// By trial. What happens to be missed by all is not quite given up.
double LightEmission::mean_power(std::size_t source, Job& job) const {
    job.check();
    const Light* light = sources_[source].light;
    const bool is_plain = sources_[source].kind == Kind::Point && !details_[source].is_cone;
    const int trials = light->is_delta() && sources_[source].kind == Kind::Infinity ? 1
                       : is_plain                                                   ? 64
                                                                                    : 1024;
    double sum = 0, largest = 0;
    for (int i = 0; i < trials; ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        const EmittedLight e = draw(source, 0, sobol_2d(n, 1), sobol_2d(n, 2), sobol_1d(n, 3));
        sum += mean_channel(e.power);
        largest = std::max(largest, mean_channel(e.power));
    }
    if (sum > 0) return sum / trials;
    if (!details_[source].is_cone) return 0;
    const auto* spot = dynamic_cast<const SpotLight*>(light);
    const LightSample full = spot->sample(details_[source].position + spot->axis(), {});
    return 1e-4 * spot->solid_angle() * mean_channel(full.weight);
}

int LightEmission::source_of_surface(int surface) const {
    return of_surface_[static_cast<std::size_t>(surface)];
}

EmittedLight LightEmission::sample(float choice, Vec2f place, Vec2f direction, float extra) const {
    if (!(power() > 0)) return {};
    const double at = static_cast<double>(choice) * power();
    const auto next = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, at);
    const auto i = static_cast<std::size_t>(next - cumulative_.begin()) - 1;
    const double left = (at - cumulative_[i]) / (cumulative_[i + 1] - cumulative_[i]);
    EmittedLight e = draw(i, std::clamp(static_cast<float>(left), 0.0f, 0x1.fffffep-1f), place,
                          direction, extra);
    if (e.kind == Kind::None) return {};
    e.choice = choice_of(i);
    e.power *= 1 / e.choice;
    return e;
}

// As if there were no other source.
EmittedLight LightEmission::draw(std::size_t i, float choice, Vec2f place, Vec2f direction,
                                 float extra) const {
    EmittedLight e;
    e.kind = sources_[i].kind;
    e.source = static_cast<int>(i);
    switch (e.kind) {
        case Kind::Point:
            draw_point(i, e, direction, extra);
            break;
        case Kind::Surface:
            draw_surface(i, e, place, direction, extra);
            break;
        case Kind::Volume:
            draw_medium(i, e, choice, place, direction, extra);
            break;
        case Kind::Infinity:
            draw_infinity(i, e, place, direction, extra);
            break;
        case Kind::None:
            break;
    }
    if (!(max_component(e.power) > 0)) e.kind = Kind::None;
    return e;
}

void LightEmission::draw_point(std::size_t i, EmittedLight& e, Vec2f direction, float extra) const {
    const Detail& d = details_[i];
    const auto* spot = d.is_cone ? static_cast<const SpotLight*>(sources_[i].light) : nullptr;
    e.ray = {d.position,
             spot ? spot->direction(direction) : target_.direction(d.position, direction, extra)};
    e.pdf_direction = point_direction_pdf(i, e.ray.direction);
    if (!(e.pdf_direction > 0)) return;
    const LightSample seen = sources_[i].light->sample(d.position + e.ray.direction, {});
    e.power = seen.weight * (1 / e.pdf_direction);
}

void LightEmission::draw_surface(std::size_t i, EmittedLight& e, Vec2f place, Vec2f direction,
                                 float extra) const {
    const Detail& d = details_[i];
    const SurfaceLight::AreaPoint p = d.surface->area_point(place);
    const bool is_inner = d.sides == 2 && extra >= 0.5f;
    SurfaceHit hit;
    hit.point = p.point;
    hit.normal = hit.shading_normal = is_inner ? -p.normal : p.normal;
    hit.front = !is_inner;
    hit.emission = d.surface->emission();
    hit.surface = d.surface->surface();
    hit.primitive = p.primitive;
    hit.offset = p.offset;
    const double sine = std::sqrt(static_cast<double>(direction.x)),
                 cosine = std::sqrt(1 - static_cast<double>(direction.x)),
                 turn = 2 * pi * static_cast<double>(direction.y);
    Vec3d s, t;
    orthonormal_frame(hit.normal, s, t);
    e.ray = {p.point, cosine * hit.normal + sine * (std::cos(turn) * s + std::sin(turn) * t)};
    e.hit = hit;
    e.pdf_place = static_cast<float>(1 / d.surface->area());
    e.pdf_direction = static_cast<float>(cosine / (pi * d.sides));
    e.power = hit.emission * static_cast<float>(pi * d.sides * d.surface->area());
}

void LightEmission::draw_infinity(std::size_t i, EmittedLight& e, Vec2f place, Vec2f direction,
                                  float extra) const {
    const Vec3d middle = 0.5 * (target_.box().lo + target_.box().hi);
    const LightSample s = sources_[i].light->sample(middle, direction);
    if (!(max_component(s.weight) > 0)) return;
    const Vec3d travel = -s.direction;
    const double area = target_.area_across(travel);
    e.ray = {target_.entry(travel, place, extra) - retreat_ * travel, travel};
    e.pdf_place = static_cast<float>(1 / area);
    e.pdf_direction = s.pdf;
    e.power = s.weight * static_cast<float>(area);
}

void LightEmission::draw_medium(std::size_t i, EmittedLight& e, float choice, Vec2f place,
                                Vec2f direction, float extra) const {
    const EmissionSample s =
        details_[i].glow->sample(details_[i].far, choice, {place.x, place.y, extra});
    if (!(s.pdf > 0)) return;
    e.medium = sources_[i].medium;
    if (has_interiors_) {
        // A medium that fills a surface is nowhere else, and the others are not in there.
        const InteriorStack inside(view_.surfaces, s.point);
        const bool is_filling = view_.surfaces.is_interior(e.medium);
        if (is_filling ? inside.medium() != e.medium : inside.surface() >= 0) return;
    }
    e.ray = {s.point, on_sphere(direction)};
    e.pdf_place = s.pdf;
    e.pdf_direction = static_cast<float>(0.25 / pi);
    e.power = e.medium->at(s.point).emission * static_cast<float>(4 * pi / double{s.pdf});
}

LightEmission::Densities LightEmission::of_surface(const SurfaceHit& hit,
                                                   const Vec3d& direction) const {
    const int source = source_of_surface(hit.surface);
    const double cosine = dot(direction, hit.normal);
    if (source < 0 || !(cosine > 0)) return {};
    const auto i = static_cast<std::size_t>(source);
    const Detail& d = details_[i];
    if (!hit.front && d.sides == 1) return {};
    return {choice_of(i), static_cast<float>(1 / d.surface->area()),
            static_cast<float>(cosine / (pi * d.sides))};
}

LightEmission::Densities LightEmission::of_infinity(int source, const Vec3d& travel) const {
    const auto i = static_cast<std::size_t>(source);
    const Vec3d middle = 0.5 * (target_.box().lo + target_.box().hi);
    return {choice_of(i), static_cast<float>(1 / target_.area_across(travel)),
            sources_[i].light->pdf(middle, -travel)};
}

float LightEmission::point_direction_pdf(std::size_t i, const Vec3d& direction) const {
    const Detail& d = details_[i];
    if (!d.is_cone) return static_cast<float>(target_.direction_pdf(d.position, direction));
    if (!target_.is_met_by({d.position, direction})) return 0;
    const auto& spot = *static_cast<const SpotLight*>(sources_[i].light);
    return static_cast<float>(spot.share(dot(direction, spot.axis())) / spot.solid_angle());
}

LightEmission::Densities LightEmission::of_point(int source, const Vec3d& direction) const {
    const auto i = static_cast<std::size_t>(source);
    return {choice_of(i), 0, point_direction_pdf(i, direction)};
}

LightEmission::Densities LightEmission::of_medium(int source, const Vec3d& point) const {
    const auto i = static_cast<std::size_t>(source);
    const Detail& d = details_[i];
    return {choice_of(i), d.glow->pdf(d.far, 0, point), static_cast<float>(0.25 / pi)};
}

}  // namespace gischt
