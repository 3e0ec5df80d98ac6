// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grid/brick_volume.h"
#include "grid/brick_walk.h"
#include "optics/blackbody.h"
#include "optics/layer.h"
#include "optics/medium_params.h"
#include "optics/phase_lobes.h"

namespace gischt {

// Absorption and scattering per unit of density, 1/m, per channel.
struct CrossSections {
    Vec3f absorption, scattering;
    Vec3f extinction() const { return absorption + scattering; }
};

// What a medium is at a point: coefficients in 1/m and the emitted power per volume and solid angle
// a L_e, W/(m^3 sr).
struct MediumPoint {
    Vec3f absorption, scattering, emission;
    Vec3f extinction() const { return absorption + scattering; }
};

// A run of a ray inside a medium with bounds of the extinction of the strongest channel, 1/m, and
// its mean over the run or a block around it. In media without end t1 may be infinite. The rest is
// for the medium's look-ups; a segment may be clipped by moving t0 and t1.
struct MediumSegment {
    double t0 = 0, t1 = 0;
    float min = 0, mean = 0, max = 0;
    // Bound of the emission a L_e of the strongest channel, W/(m^3 sr). It is positive also where
    // something glows without density (max = 0), which trackers must not skip.
    float emission_max = 0;

    double anchor = 0;                // the t from which look-ups count
    int brick = -1, glow_brick = -1;  // of the density and of what glows; -1: no brick
    Vec3f entry, step;
};

// A box or an ellipsoid in space, filled evenly, or all of space.
struct Region {
    enum class Kind { Box, Ellipsoid, Everywhere };
    Kind kind = Kind::Box;
    Vec3d center, size{1, 1, 1};  // metres: edges or diameters, before the rotation
    Transform rotation{};         // around the centre, no translation, no scale

    static Region box(const Box3d& b) { return {Kind::Box, 0.5 * (b.lo + b.hi), b.size(), {}}; }
    static Region sphere(const Vec3d& center, double radius) {
        return {Kind::Ellipsoid, center, Vec3d(2 * radius), {}};
    }
    static Region everywhere() { return {Kind::Everywhere, {}, {1, 1, 1}, {}}; }
    // From [-1,1]^3, or the unit ball, to metres.
    Transform to_world() const;
};

class SegmentWalk;

// Of a segment: a brick's diagonal crosses 21 planes.
inline constexpr std::size_t most_cell_crossings = 32;

// A participating medium at one moment: extinction, scattering, emission and a phase function as
// functions of the place. The coefficients are a scalar density(x) >= 0 times constant cross
// sections; where has_color(), a colour in [0,1] multiplies the scattering and what it takes is
// absorbed, so that the extinction stays. Immutable, safe to use from several threads.
class Medium {
  public:
    // The density field of a frame, and its temperature or flame where that glows. Values below
    // zero and those that are not finite count as 0, colours above one as 1; the last two are
    // reported to the job. Throws Error{Input} when a field is missing, naming those there are.
    // All media: Error{Input} where extinction or emission exceed 1e30.
    Medium(const Frame& frame, const MediumParams& params, double time, Job& job);
    // Density 1 inside a region, nothing outside. Emission by blackbody takes `temperature` in K.
    // Throws Error{Usage} when the region has no volume, or no end but a glow.
    Medium(const Region& region, const MediumParams& params, double time, double temperature = 0);
    // A layer, its density being the layer's. Throws Error{Usage} when it is to glow.
    Medium(const Layer& layer, const MediumParams& params, double time);

    const CrossSections& cross_sections() const { return cross_sections_; }
    const PhaseFunction& phase() const { return phase_; }
    const PhaseLobes& phase_lobes() const { return phase_lobes_; }
    const MultipleScattering& multiple_scattering() const { return multiple_scattering_; }
    bool is_emissive() const { return emission_ != EmissionKind::None; }
    bool has_color() const { return !dyed_.empty(); }
    // Extinction of the strongest channel at density 1, 1/m; segments count in it.
    float strength() const { return strength_; }
    // Largest extinction of the strongest channel anywhere, 1/m.
    float majorant() const { return majorant_; }
    // Largest emission of the strongest channel anywhere, W/(m^3 sr).
    float emission_majorant() const { return emission_majorant_; }
    // Box around all that absorbs, scatters or glows, metres; empty where nothing does, infinite
    // where the medium has no end.
    Box3d bounds() const;
    bool is_bounded() const {
        return shape_ != Shape::Everywhere && (!layer_ || layer_->is_round());
    }
    // Edge of the smallest detail in metres (a voxel), 0 for media without a grid.
    double cell_size() const { return cell_size_; }
    // Where look-up grids are best laid: a map to metres whose integer points are the samples of
    // the density, and the box in it that holds everything. For homogeneous media the longest edge
    // of the box counts 64. Only where has_lattice(): not for layers and media without end.
    struct Lattice {
        Transform to_world;
        Box3d box;
    };
    Lattice lattice() const;
    bool has_lattice() const { return shape_ != Shape::Everywhere && shape_ != Shape::Layered; }

    // The bricks of the density; null for media without a grid.
    const BrickVolume* bricks() const { return shape_ == Shape::Bricks ? &density_ : nullptr; }
    // Of a block of a brick: bound of the emission of the strongest channel, and mean over its 64
    // cells' centres, W/(m^3 sr).
    float emission_bound(int brick, int block) const {
        return emission_bounds_[static_cast<std::size_t>(brick * bounds_per_brick + block)];
    }
    Vec3f mean_emission(int brick, int block) const;
    // Of a homogeneous medium: from [-1,1]^3, or from the unit ball, to metres.
    const Transform& region_to_world() const { return to_world_; }
    bool is_ellipsoid() const { return shape_ == Shape::Ellipsoid; }

    // At a point in metres, for probes; along rays use segments.
    float density(const Vec3d& point) const;
    MediumPoint at(const Vec3d& point) const;

    // The runs of a ray through the medium in ascending order; where there is nothing there is no
    // run. Fine runs (4^3 voxels) have tight bounds, coarse ones (8^3) are half as many.
    SegmentWalk segments(const Ray& ray, BrickGrain grain = BrickGrain::Blocks) const;
    // Density at anchor + t[i], which must lie in the segment.
    void densities(const MediumSegment& segment, std::span<const float> t, float* out) const;
    // The t in ]begin, end[ of a segment at which the density passes from one interpolation cell to
    // the next; between them it is a cubic polynomial of t. `out` holds most_cell_crossings.
    int cell_crossings_of(const MediumSegment& segment, float begin, float end,
                          std::span<float> out) const;
    // Emission a L_e in W/(m^3 sr) at the same places, `density` being what densities() gave.
    void emissions(const MediumSegment& segment, std::span<const float> t, const float* density,
                   Vec3f* out) const;
    // The same for one place, for trackers.
    float density_at(const MediumSegment& segment, float t) const {
        if (segment.brick >= 0) {
            // Beside a voxel of 1e10 rounding may take an interpolated 1 below 0.
            return density_scale_ *
                   std::max(density_.at_local(segment.brick, segment.entry + t * segment.step),
                            0.0f);
        }
        if (!layer_) return density_scale_;
        return density_scale_ * density_on_run(layer_->profile(), layer_->is_round(), segment.entry,
                                               segment.step, t);
    }
    Vec3f emission_at(const MediumSegment& segment, float t, float density) const {
        return is_emissive() ? glow(density, glow_at(segment, t)) : Vec3f{};
    }
    // Colour, by which the cross section of scattering is multiplied; white where there is none.
    Vec3f color_at(const MediumSegment& segment, float t, float density) const {
        if (!has_color() || !(density > 0)) return Vec3f(1);
        const Vec3f local = segment.entry + t * segment.step;
        const Vec3f dyed(dyed_[0].at_local(segment.brick, local),
                         dyed_[1].at_local(segment.brick, local),
                         dyed_[2].at_local(segment.brick, local));
        return min((density_scale_ / density) * dyed, Vec3f(1));
    }
    // Optical depth of the strongest channel, in which segments count, along a ray for t in
    // [t0, t1]; the others are in the ratio of their extinction to strength(). Only for media
    // without a grid: exact, over a sphere within 1e-6. May be infinite.
    std::optional<float> optical_depth(const Ray& ray, double t0, double t1) const;

  private:
    friend class SegmentWalk;

    enum class Shape { Bricks, Box, Ellipsoid, Everywhere, Layered };

    Interval inside(const Ray& ray) const;
    void take(const MediumParams& params, double time);
    void check_bounds(const std::string& of) const;
    void bound_emission();
    float bound_of_glow(float density, float least, float most) const;
    Vec3f glow(float density, float value) const;
    float glow_at(const MediumSegment& s, float t) const {
        return s.glow_brick < 0 ? glow_elsewhere_
                                : glow_.at_local(s.glow_brick, s.entry + t * s.step);
    }

    Shape shape_ = Shape::Bricks;
    BrickVolume density_;
    BrickVolume glow_;               // temperature or flame, on the lattice of density
    std::vector<BrickVolume> dyed_;  // none, or density times colour with the bricks of density
    // Bounds of the emission by brick: eight of its blocks and one of the whole.
    static constexpr int bounds_per_brick = BrickVolume::brick_blocks + 1;
    std::vector<float> emission_bounds_;
    std::optional<Layer> layer_;
    Transform to_world_, to_unit_;  // of a region: from [-1,1]^3 to metres and back
    float glow_elsewhere_ = 0;      // where glow_ has no brick: K of a region, a background
    CrossSections cross_sections_;
    PhaseFunction phase_;
    PhaseLobes phase_lobes_;
    MultipleScattering multiple_scattering_;
    EmissionKind emission_ = EmissionKind::None;
    double cell_size_ = 0;
    float density_scale_ = 1, strength_ = 0, majorant_ = 0;
    float emission_scale_ = 1, emission_majorant_ = 0;
    Vec2f temperature_range_{0, 1};
    std::shared_ptr<const BlackbodyTable> blackbody_;
};

// A pull iterator over the segments of a medium along a ray. The medium must outlive it.
class SegmentWalk {
  public:
    SegmentWalk(const Medium& medium, const Ray& ray, BrickGrain grain);
    bool next(MediumSegment& segment);

  private:
    bool next_of_layer(MediumSegment& segment);

    const Medium* medium_;
    std::optional<BrickWalk> bricks_;
    std::optional<LayerWalk> layer_;
    MediumSegment once_;  // the single run of a homogeneous medium
    bool done_ = false;
};

}  // namespace gischt
