// SPDX-License-Identifier: Apache-2.0
#include "optics/medium.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "grid/cell_crossings.h"
#include "grid/resample.h"

namespace gischt {
namespace {

// The part of a ray inside the unit ball.
Interval clip_to_ball(const Ray& ray) {
    const double a = dot(ray.direction, ray.direction);
    const double b = dot(ray.origin, ray.direction) / a;
    // The squared distance of the line to the centre, without the cancellation of b^2 - c.
    const Vec3d nearest = ray.origin - b * ray.direction;
    const double d = (1 - dot(nearest, nearest)) / a;
    if (!(d > 0)) return {};
    const double root = std::sqrt(d);
    return {std::max(ray.t_min, -b - root), std::min(ray.t_max, -b + root)};
}

constexpr Box3d unit_box{{-1, -1, -1}, {1, 1, 1}};

}  // namespace

Transform Region::to_world() const {
    Transform t = rotation;
    for (int a = 0; a < 3; ++a) t.column[static_cast<std::size_t>(a)] *= 0.5 * size[a];
    t.translation = center;
    return t;
}

Medium::Medium(const Frame& frame, const MediumParams& params, double time, Job& job) {
    take(params, time);
    Bricks& b = kind_.emplace<Bricks>();
    const Field* density = frame.find(params.density_field);
    const Transform* lattice = density ? &density->to_world : nullptr;
    if (is_emissive()) {
        const bool flame = emission_ == EmissionKind::Flame;
        b.glow = pack(frame, params.emission_field.value_or(flame ? "flame" : "temperature"),
                      {.non_negative = flame}, lattice, job);
    }
    b.density =
        pack(frame, params.density_field,
             {.non_negative = true, .also = emission_ == EmissionKind::Flame ? &*b.glow : nullptr},
             lattice, job);
    majorant_ = strength_ * density_scale_ * b.density.max();
    if (b.density.size() > 0) cell_size_ = b.density.cell_size();
}

Medium::Medium(const Region& region, const MediumParams& params, double time, double temperature) {
    take(params, time);
    if (!(min_component(region.size) > 0)) {
        throw Error(ErrorKind::Usage, "medium", "the region has no volume",
                    "give it a positive size");
    }
    if (emission_ == EmissionKind::Flame) {
        throw Error(ErrorKind::Usage, "medium", "emission 'flame' needs a frame with that field",
                    "take 'blackbody'");
    }
    const Transform to_world = region.to_world();
    kind_ = Homogeneous{region.kind, to_world, to_world.inverse(), static_cast<float>(temperature)};
    majorant_ = strength_ * density_scale_;
}

void Medium::take(const MediumParams& params, double time) {
    if (params.absorption && params.scattering) {
        cross_sections_ = {Vec3f(params.absorption->at(time)), Vec3f(params.scattering->at(time))};
    } else {
        const Vec3d extinction = params.extinction.at(time), albedo = params.albedo.at(time);
        cross_sections_ = {Vec3f(extinction * (Vec3d(1) - albedo)), Vec3f(extinction * albedo)};
    }
    phase_ = make_phase(params.phase, params.g.at(time));
    multiple_scattering_ = params.multiple_scattering;
    density_scale_ = static_cast<float>(params.density_scale.at(time));
    strength_ = max_component(cross_sections_.extinction());
    emission_ = params.emission;
    emission_scale_ = static_cast<float>(params.emission_scale.at(time));
    const Vec2d range = params.temperature_range.value_or(
        emission_ == EmissionKind::Flame ? Vec2d{1000, 1900} : Vec2d{0, 1});
    temperature_range_ = {static_cast<float>(range.x), static_cast<float>(range.y)};
    if (is_emissive()) blackbody_ = std::make_shared<const BlackbodyTable>();
}

// Packs a field of the frame, on another lattice if that is not its own.
BrickVolume Medium::pack(const Frame& frame, const std::string& name, const BrickOptions& options,
                         const Transform* lattice, Job& job) const {
    const Field* field = frame.find(name);
    if (!field) {
        std::vector<std::string> names;
        for (const auto& [key, value] : frame.fields) names.push_back(key);
        throw Error(ErrorKind::Input, "medium", fmt::format("the frame has no field '{}'", name),
                    names.empty() ? "it has no fields at all"
                                  : fmt::format("fields: {}", fmt::join(names, ", ")));
    }
    if (field->is_vector()) {
        throw Error(ErrorKind::Input, "medium", fmt::format("field '{}' is a vector", name),
                    "a medium needs a scalar");
    }
    const BrickVolume volume = !lattice || field->to_world == *lattice
                                   ? BrickVolume(*field, options, job)
                                   : BrickVolume(resample(*field, 0, *lattice, job), options, job);
    if (volume.non_finite() > 0) {
        job.warn(fmt::format("field '{}': {} values that are not finite count as {:g}", name,
                             volume.non_finite(), volume.background()));
    }
    return volume;
}

Box3d Medium::bounds() const {
    if (const Bricks* b = std::get_if<Bricks>(&kind_)) return b->density.world_bounds();
    return std::get<Homogeneous>(kind_).to_world.bounds(unit_box);
}

Medium::Lattice Medium::lattice() const {
    if (const Bricks* b = std::get_if<Bricks>(&kind_)) {
        const Box3i& support = b->density.support();
        return {b->density.to_world(), {Vec3d(support.lo), Vec3d(support.hi)}};
    }
    const Box3d box = bounds();
    const double h = max_component(box.size()) / 64;
    return {Transform::scale_translate(h, box.lo), {{}, box.size() / Vec3d(h)}};
}

float Medium::density(const Vec3d& point) const {
    if (const Bricks* b = std::get_if<Bricks>(&kind_)) {
        return density_scale_ * b->density.sample(point);
    }
    const Homogeneous& solid = std::get<Homogeneous>(kind_);
    const Vec3d p = solid.to_unit.point(point);
    const bool inside =
        solid.shape == Region::Kind::Box ? max_component(abs(p)) <= 1 : dot(p, p) <= 1;
    return inside ? density_scale_ : 0.0f;
}

MediumPoint Medium::at(const Vec3d& point) const {
    const float d = density(point);
    MediumPoint p{d * cross_sections_.absorption, d * cross_sections_.scattering, {}};
    if (is_emissive()) {
        const Bricks* b = std::get_if<Bricks>(&kind_);
        p.emission = glow(d, b ? b->glow->sample(point) : std::get<Homogeneous>(kind_).temperature);
    }
    return p;
}

// Emission by the value of the temperature or flame field.
Vec3f Medium::glow(float density, float value) const {
    const float kelvin =
        temperature_range_.x + (temperature_range_.y - temperature_range_.x) * value;
    const Vec3f radiance = emission_scale_ * blackbody_->radiance(kelvin);
    if (emission_ == EmissionKind::Flame) return value * radiance;
    return density * cross_sections_.absorption * radiance;
}

SegmentWalk Medium::segments(const Ray& ray, BrickGrain grain) const {
    return SegmentWalk(*this, ray, grain);
}

void Medium::densities(const MediumSegment& segment, std::span<const float> t, float* out) const {
    if (const Bricks* b = std::get_if<Bricks>(&kind_)) {
        b->density.along(segment.brick, segment.entry, segment.step, t.data(),
                         static_cast<int>(t.size()), out);
        for (std::size_t i = 0; i < t.size(); ++i) out[i] *= density_scale_;
    } else {
        std::fill_n(out, t.size(), density_scale_);
    }
}

float Medium::density_at(const MediumSegment& segment, float t) const {
    const Bricks* b = std::get_if<Bricks>(&kind_);
    if (!b) return density_scale_;
    return density_scale_ * b->density.at_local(segment.brick, segment.entry + t * segment.step);
}

Vec3f Medium::emission_at(const MediumSegment& segment, float t, float density) const {
    Vec3f out;
    emissions(segment, {&t, 1}, &density, &out);
    return out;
}

int Medium::cell_crossings_of(const MediumSegment& segment, float begin, float end,
                              std::span<float> out) const {
    if (!std::holds_alternative<Bricks>(kind_)) return 0;
    const int n =
        cell_crossings(segment.entry + begin * segment.step, segment.step, end - begin, out);
    for (int i = 0; i < n; ++i) out[static_cast<std::size_t>(i)] += begin;
    return n;
}

void Medium::emissions(const MediumSegment& segment, std::span<const float> t, const float* density,
                       Vec3f* out) const {
    const Bricks* b = std::get_if<Bricks>(&kind_);
    if (!is_emissive() || !b) {
        const float value = b ? 0 : std::get<Homogeneous>(kind_).temperature;
        for (std::size_t i = 0; i < t.size(); ++i) {
            out[i] = is_emissive() ? glow(density[i], value) : Vec3f{};
        }
        return;
    }
    const int brick = b->glow->find(segment.coord);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const float value = brick < 0
                                ? b->glow->background()
                                : b->glow->at_local(brick, segment.entry + t[i] * segment.step);
        out[i] = glow(density[i], value);
    }
}

SegmentWalk::SegmentWalk(const Medium& medium, const Ray& ray, BrickGrain grain)
    : medium_(&medium) {
    if (const auto* b = std::get_if<Medium::Bricks>(&medium.kind_)) {
        bricks_.emplace(b->density, ray, grain);
        return;
    }
    const auto& solid = std::get<Medium::Homogeneous>(medium.kind_);
    const Ray unit{solid.to_unit.point(ray.origin), solid.to_unit.vector(ray.direction), ray.t_min,
                   ray.t_max};
    const Interval t = solid.shape == Region::Kind::Box ? clip(unit, unit_box) : clip_to_ball(unit);
    done_ = t.is_empty();
    once_.t0 = once_.anchor = t.t0;
    once_.t1 = t.t1;
    once_.min = once_.mean = once_.max = medium.majorant_;
}

bool SegmentWalk::next(MediumSegment& segment) {
    if (!bricks_) {
        if (done_) return false;
        segment = once_;
        return done_ = true;
    }
    BrickRun run;
    if (!bricks_->next(run)) return false;
    const float scale = medium_->strength_ * medium_->density_scale_;
    segment.t0 = segment.anchor = run.t0;
    segment.t1 = run.t1;
    segment.min = scale * run.bounds.min;
    segment.mean = scale * run.bounds.mean;
    segment.max = scale * run.bounds.max;
    segment.brick = run.brick;
    segment.coord = run.coord;
    segment.entry = run.entry;
    segment.step = bricks_->step();
    return true;
}

}  // namespace gischt
