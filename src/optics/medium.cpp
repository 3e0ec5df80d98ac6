// SPDX-License-Identifier: Apache-2.0
#include "optics/medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "grid/cell_crossings.h"
#include "optics/medium_pack.h"

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
    const Field* density = frame.find(params.density_field);
    const Transform* lattice = density ? &density->to_world : nullptr;
    const bool flame = emission_ == EmissionKind::Flame;
    if (is_emissive()) {
        glow_ = pack_scalar(frame, params.emission_field.value_or(flame ? "flame" : "temperature"),
                            {.non_negative = flame}, lattice, job);
        glow_elsewhere_ = glow_.background();
    }
    density_ = pack_scalar(frame, params.density_field,
                           {.non_negative = true, .also = flame ? &glow_ : nullptr}, lattice, job);
    if (params.color_field) {
        dyed_ = pack_dyed_density(frame, params.density_field, *params.color_field, density_, job);
    }
    majorant_ = strength_ * density_scale_ * density_.max();
    if (density_.size() > 0) cell_size_ = density_.cell_size();
    if (is_emissive()) bound_emission();
    check_bounds(params.density_field);
}

Medium::Medium(const Region& region, const MediumParams& params, double time, double temperature) {
    take(params, time);
    if (params.color_field) {
        throw Error(ErrorKind::Usage, "medium", "a color_field needs a frame", "take albedo");
    }
    if (!(min_component(region.size) > 0)) {
        throw Error(ErrorKind::Usage, "medium", "the region has no volume",
                    "give it a positive size");
    }
    if (emission_ == EmissionKind::Flame) {
        throw Error(ErrorKind::Usage, "medium", "emission 'flame' needs a frame with that field",
                    "take 'blackbody'");
    }
    shape_ = region.kind == Region::Kind::Box         ? Shape::Box
             : region.kind == Region::Kind::Ellipsoid ? Shape::Ellipsoid
                                                      : Shape::Everywhere;
    if (is_emissive() && !is_bounded()) {
        throw Error(ErrorKind::Usage, "medium", "what fills all of space cannot glow",
                    "give it a box or a sphere");
    }
    to_world_ = region.to_world();
    to_unit_ = to_world_.inverse();
    glow_elsewhere_ = static_cast<float>(temperature);
    majorant_ = strength_ * density_scale_;
    if (is_emissive()) {
        emission_majorant_ = bound_of_glow(density_scale_, glow_elsewhere_, glow_elsewhere_);
    }
    check_bounds("region");
}

Medium::Medium(const Layer& layer, const MediumParams& params, double time) {
    take(params, time);
    if (is_emissive()) {
        throw Error(ErrorKind::Usage, "medium", "a layer cannot glow", "take emission 'none'");
    }
    shape_ = Shape::Layered;
    layer_ = layer;
    majorant_ = strength_ * density_scale_ * static_cast<float>(layer.greatest_density());
    check_bounds("layer");
}

// Depths along a ray are to stay numbers.
void Medium::check_bounds(const std::string& of) const {
    constexpr float most = 1e30f;
    if (majorant_ <= most && strength_ <= most && emission_majorant_ <= most) return;
    throw Error(
        ErrorKind::Input, "medium",
        fmt::format("'{}' has an extinction of up to {:.3g} 1/m and glows with up to {:.3g} "
                    "W/(m^3 sr); the most that can be reckoned with is {:.3g}",
                    of, majorant_, emission_majorant_, most),
        "lower density_scale, extinction or emission_scale");
}

void Medium::take(const MediumParams& params, double time) {
    if (params.absorption && params.scattering) {
        cross_sections_ = {Vec3f(params.absorption->at(time)), Vec3f(params.scattering->at(time))};
    } else {
        const Vec3d extinction = params.extinction.at(time), albedo = params.albedo.at(time);
        cross_sections_ = {Vec3f(extinction * (Vec3d(1) - albedo)), Vec3f(extinction * albedo)};
    }
    phase_ = make_phase(
        {params.phase, params.g.at(time), params.g2, params.lobe_weight, params.droplet_diameter});
    phase_lobes_ = PhaseLobes::of(phase_);
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

Box3d Medium::bounds() const {
    if (shape_ == Shape::Bricks) return density_.world_bounds();
    if (layer_) return layer_->bounds();
    if (is_bounded()) return to_world_.bounds(unit_box);
    constexpr double never = std::numeric_limits<double>::infinity();
    return {Vec3d(-never), Vec3d(never)};
}

Medium::Lattice Medium::lattice() const {
    if (shape_ == Shape::Bricks) {
        const Box3i& support = density_.support();
        return {density_.to_world(), {Vec3d(support.lo), Vec3d(support.hi)}};
    }
    GISCHT_ASSERT(has_lattice());
    const Box3d box = bounds();
    const double h = max_component(box.size()) / 64;
    return {Transform::scale_translate(h, box.lo), {{}, box.size() / Vec3d(h)}};
}

float Medium::density(const Vec3d& point) const {
    if (shape_ == Shape::Bricks) return density_scale_ * density_.sample(point);
    if (layer_) return density_scale_ * static_cast<float>(layer_->density(point));
    const Vec3d p = to_unit_.point(point);
    const bool is_inside = shape_ == Shape::Box         ? max_component(abs(p)) <= 1
                           : shape_ == Shape::Ellipsoid ? dot(p, p) <= 1
                                                        : true;
    return is_inside ? density_scale_ : 0.0f;
}

MediumPoint Medium::at(const Vec3d& point) const {
    const float d = density(point);
    MediumPoint p{d * cross_sections_.absorption, d * cross_sections_.scattering, {}};
    if (has_color() && d > 0) {
        const Vec3f color =
            (density_scale_ / d) *
            Vec3f(dyed_[0].sample(point), dyed_[1].sample(point), dyed_[2].sample(point));
        const Vec3f extinction = p.extinction();
        p.scattering = p.scattering * min(color, Vec3f(1));
        p.absorption = extinction - p.scattering;
    }
    if (is_emissive()) {
        p.emission = glow(d, shape_ == Shape::Bricks ? glow_.sample(point) : glow_elsewhere_);
    }
    return p;
}

// Emission by the value of the temperature or flame field.
Vec3f Medium::glow(float density, float value) const {
    const bool flame = emission_ == EmissionKind::Flame;
    if ((flame ? value : density) == 0) return {};
    const float kelvin =
        temperature_range_.x + (temperature_range_.y - temperature_range_.x) * value;
    const Vec3f radiance = emission_scale_ * blackbody_->radiance(kelvin);
    return flame ? value * radiance : density * cross_sections_.absorption * radiance;
}

// Bound of glow() for densities up to `density` and values in [least, most], between which the
// temperature is linear and the radiance grows with it.
float Medium::bound_of_glow(float density, float least, float most) const {
    const float cold = max_component(glow(density, least));
    float bound = std::max(cold, max_component(glow(density, most)));
    if (emission_ == EmissionKind::Flame && least > 0) bound = std::max(bound, cold / least * most);
    return bound * (1 + 1e-5f);  // of the rounding on the way
}

void Medium::bound_emission() {
    emission_bounds_.resize(static_cast<std::size_t>(density_.size()) * bounds_per_brick);
    for (int brick = 0; brick < density_.size(); ++brick) {
        const int other = glow_.find(density_.coord(brick));
        float* bounds = &emission_bounds_[static_cast<std::size_t>(brick) * bounds_per_brick];
        for (int b = 0; b < BrickVolume::brick_blocks; ++b) {
            if (!(density_.occupied(brick) >> b & 1)) continue;
            const float none = glow_elsewhere_;
            const BrickVolume::Block value =
                other < 0 ? BrickVolume::Block{none, none, none} : glow_.block(other, b);
            bounds[b] =
                bound_of_glow(density_scale_ * density_.block(brick, b).max, value.min, value.max);
            float& whole = bounds[BrickVolume::brick_blocks];
            whole = std::max(whole, bounds[b]);
            emission_majorant_ = std::max(emission_majorant_, bounds[b]);
        }
    }
}

Vec3f Medium::mean_emission(int brick, int block) const {
    const int other = glow_.find(density_.coord(brick));
    const Vec3f first(static_cast<float>(4 * (block & 1)), static_cast<float>(4 * (block >> 1 & 1)),
                      static_cast<float>(4 * (block >> 2)));
    Vec3f sum;
    for (int i = 0; i < 64; ++i) {
        const Vec3f cell(static_cast<float>(i & 3), static_cast<float>(i >> 2 & 3),
                         static_cast<float>(i >> 4));
        const Vec3f local = first + cell + Vec3f(0.5f);
        const float value = other < 0 ? glow_elsewhere_ : glow_.at_local(other, local);
        sum += glow(density_scale_ * density_.at_local(brick, local), value);
    }
    return sum * (1.0f / 64);
}

SegmentWalk Medium::segments(const Ray& ray, BrickGrain grain) const {
    return SegmentWalk(*this, ray, grain);
}

void Medium::densities(const MediumSegment& segment, std::span<const float> t, float* out) const {
    if (segment.brick < 0) {
        for (std::size_t i = 0; i < t.size(); ++i) out[i] = density_at(segment, t[i]);
        return;
    }
    density_.along(segment.brick, segment.entry, segment.step, t.data(), static_cast<int>(t.size()),
                   out);
    for (std::size_t i = 0; i < t.size(); ++i) out[i] = density_scale_ * std::max(out[i], 0.0f);
}

int Medium::cell_crossings_of(const MediumSegment& segment, float begin, float end,
                              std::span<float> out) const {
    if (segment.brick < 0) return 0;
    const int n =
        cell_crossings(segment.entry + begin * segment.step, segment.step, end - begin, out);
    for (int i = 0; i < n; ++i) out[static_cast<std::size_t>(i)] += begin;
    return n;
}

void Medium::emissions(const MediumSegment& segment, std::span<const float> t, const float* density,
                       Vec3f* out) const {
    for (std::size_t i = 0; i < t.size(); ++i) out[i] = emission_at(segment, t[i], density[i]);
}

std::optional<float> Medium::optical_depth(const Ray& ray, double t0, double t1) const {
    if (shape_ == Shape::Bricks) return std::nullopt;
    if (layer_) {
        if (majorant_ == 0) return 0.0f;
        return strength_ * density_scale_ *
               static_cast<float>(layer_->column({ray.origin, ray.direction, t0, t1}));
    }
    const Interval t = inside({ray.origin, ray.direction, t0, t1});
    if (t.is_empty() || majorant_ == 0) return 0.0f;
    return static_cast<float>((t.t1 - t.t0) * length(ray.direction) *
                              static_cast<double>(majorant_));
}

// The part of a ray inside the region.
Interval Medium::inside(const Ray& ray) const {
    if (shape_ == Shape::Everywhere) return {ray.t_min, ray.t_max};
    const Ray unit{to_unit_.point(ray.origin), to_unit_.vector(ray.direction), ray.t_min,
                   ray.t_max};
    return shape_ == Shape::Box ? clip(unit, unit_box) : clip_to_ball(unit);
}

SegmentWalk::SegmentWalk(const Medium& medium, const Ray& ray, BrickGrain grain)
    : medium_(&medium) {
    if (medium.shape_ == Medium::Shape::Bricks) {
        bricks_.emplace(medium.density_, ray, grain);
        return;
    }
    if (medium.layer_) {
        layer_.emplace(*medium.layer_, ray);
        return;
    }
    const Interval t = medium.inside(ray);
    done_ = t.is_empty();
    once_.t0 = once_.anchor = t.t0;
    once_.t1 = t.t1;
    once_.min = once_.mean = once_.max = medium.majorant_;
    once_.emission_max = medium.emission_majorant_;
}

bool SegmentWalk::next(MediumSegment& segment) {
    if (layer_) return next_of_layer(segment);
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
    segment.entry = run.entry;
    segment.step = bricks_->step();
    if (medium_->is_emissive()) {
        segment.glow_brick = medium_->glow_.find(run.coord);
        segment.emission_max = medium_->emission_bound(
            run.brick, run.block < 0 ? BrickVolume::brick_blocks : run.block);
    }
    return true;
}

bool SegmentWalk::next_of_layer(MediumSegment& segment) {
    LayerRun run;
    if (!layer_->next(run)) return false;
    const double scale = static_cast<double>(medium_->strength_ * medium_->density_scale_);
    segment = {};
    segment.t0 = segment.anchor = run.t0;
    segment.t1 = run.t1;
    segment.min = static_cast<float>(scale * run.min);
    segment.mean = static_cast<float>(scale * run.mean);
    segment.max = static_cast<float>(scale * run.max);
    segment.entry = run.entry;
    segment.step = run.step;
    return true;
}

}  // namespace gischt
