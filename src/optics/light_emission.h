// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/job.h"
#include "math/box.h"
#include "math/ray.h"
#include "optics/box_target.h"
#include "optics/emission_sampler.h"
#include "optics/surface_light.h"
#include "optics/view.h"

namespace gischt {

// Light that leaves a source: the start of a photon, or of a path that begins at a light.
struct EmittedLight {
    enum class Kind { None, Point, Surface, Volume, Infinity };
    Kind kind = Kind::None;  // None: nothing was drawn
    int source = -1;         // which of LightEmission::sources()
    // Leaves the source. Of a surface it starts at hit->point (see leaving_ray); of a light at
    // infinity outside of the reach.
    Ray ray;
    // Of a surface that glows: the place, seen from the side that it shines to; without colour.
    std::optional<SurfaceHit> hit;
    const Medium* medium = nullptr;  // that glows at ray.origin
    // W: radiance (or intensity, ...) * cosine / (choice * pdf_place * pdf_direction). Where the
    // index of refraction is n it is the power over n^2, radiance being told as L / n^2 (bsdf.h).
    Vec3f power;
    float choice = 0;         // probability of the source
    float pdf_place = 0;      // 1/m^2 on the surface, or across the direction at infinity; 1/m^3 in
                              // a medium; 0: a single place
    float pdf_direction = 0;  // 1/sr; 0: a single direction (a sun without size)
};

// Everything in a view that shines (points, spots, suns, skies, constant light, surfaces that glow
// and stand still, media that glow), as a source of light rays. Sources are chosen in proportion to
// about the power that they send into the reach; places evenly over a surface, over the cross
// section of the target, and by its power in a medium; directions by the cosine, by the radiance of
// a sky, evenly over what a point sees of the target. Immutable, safe to use from several threads.
class LightEmission {
  public:
    struct Source {
        EmittedLight::Kind kind{};
        const Light* light = nullptr;    // null for a medium
        int index = -1;                  // in view.lights; -1 for a surface and a medium
        const Medium* medium = nullptr;  // that glows
        double power = 0;  // about the W that it sends into the reach, mean of the channels
    };
    // `reach`: a finite box around all that light can meet, of which at most one edge is 0.
    // `aim`: where set, rays of points, spots, suns and skies that miss this box, which has to
    // overlap the reach, are not drawn. The view must outlive it. Throws Error{Cancelled}.
    LightEmission(const View& view, const Box3d& reach, const std::optional<Box3d>& aim, Job& job);

    // All numbers in [0,1). Kind::None where what was drawn carries no light.
    EmittedLight sample(float choice, Vec2f place, Vec2f direction, float extra) const;

    // The densities with which sample() starts a path, as EmittedLight has them; all 0 for what it
    // never draws.
    struct Densities {
        float choice = 0, place = 0, direction = 0;
    };
    // Light leaves the point `hit`, told as seen from the side that it leaves to.
    Densities of_surface(const SurfaceHit& hit, const Vec3d& direction) const;
    // Light travels along `travel` and meets the target.
    Densities of_infinity(int source, const Vec3d& travel) const;
    Densities of_point(int source, const Vec3d& direction) const;
    Densities of_medium(int source, const Vec3d& point) const;

    const std::vector<Source>& sources() const { return sources_; }
    // The source that a surface is; -1 for none.
    int source_of_surface(int surface) const;
    double power() const { return cumulative_.back(); }  // W, of all

  private:
    // What is known of a source beside.
    struct Detail {
        // Of a spot that is narrower than the target: from its cone.
        bool is_cone = false;
        Vec3d position;                         // of a point or a spot
        const SurfaceLight* surface = nullptr;  // of a surface
        int sides = 1;                          // to which it shines
        std::shared_ptr<const EmissionSampler> glow;
        Vec3d far;  // a receiver so far away that the sampler draws by power alone
    };
    void add(Source source, Detail detail);
    void add_light(const Light& light, int index);
    void add_surfaces();
    void add_media();
    double mean_power(std::size_t source, Job& job) const;

    void draw_point(std::size_t i, EmittedLight& e, Vec2f direction, float extra) const;
    void draw_surface(std::size_t i, EmittedLight& e, Vec2f place, Vec2f direction,
                      float extra) const;
    void draw_infinity(std::size_t i, EmittedLight& e, Vec2f place, Vec2f direction,
                       float extra) const;
    void draw_medium(std::size_t i, EmittedLight& e, float choice, Vec2f place, Vec2f direction,
                     float extra) const;
    EmittedLight draw(std::size_t i, float choice, Vec2f place, Vec2f direction, float extra) const;
    float point_direction_pdf(std::size_t i, const Vec3d& direction) const;  // 1/sr
    float choice_of(std::size_t i) const {
        return static_cast<float>((cumulative_[i + 1] - cumulative_[i]) / power());
    }

    const View& view_;
    BoxTarget target_;
    double retreat_;  // m, from any point of the target to outside of the reach
    bool has_interiors_ = false;
    std::vector<Source> sources_;
    std::vector<Detail> details_;
    std::vector<double> cumulative_;  // power before each source
    std::vector<int> of_surface_;     // source by surface
};

}  // namespace gischt
