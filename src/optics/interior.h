// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "optics/surface.h"

namespace gischt {

// Which surfaces with an inside a point of a light path lies in, and so what surrounds it. Where
// insides overlap, that of the highest priority counts (Schmidt & Budge 2002, "Simple nested
// dielectrics in ray traced images"), among equals the one entered last, which suits things that
// lie inside of each other whole. Boundaries of a dielectric inside of one that counts more are
// false: light passes them as if they were not there. So it does at boundaries of material None,
// which only change the medium.
//
// A path keeps one by value. At a hit:
//     const Crossing c = interiors.at(hit);
//     if (c.is_false) { interiors.cross(hit); go on straight; }
//     else scatter by surfaces.bsdf(hit, c.relative_ior); if it was transmission: cross(hit)
class InteriorStack {
  public:
    // Outside of everything. The set must outlive it.
    explicit InteriorStack(const SurfaceSet& surfaces) : surfaces_(&surfaces) {}
    // At a point, for the start of a camera path. Costs a few rays.
    InteriorStack(const SurfaceSet& surfaces, const Vec3d& point, float moment = 0.5f);

    struct Crossing {
        bool is_false = false;    // nothing happens here: to be passed, and crossed
        double relative_ior = 1;  // index of refraction of the far side over the near side
    };
    Crossing at(const SurfaceHit& hit) const;
    // The path goes through the surface that it hit. Throws Error{Usage} where more than `capacity`
    // insides overlap.
    void cross(const SurfaceHit& hit);

    // The surface whose inside this is; -1 outside of all. Inside of any, only medium() fills the
    // place, and the media of the view that fill no surface do not.
    int surface() const { return top(-1, 0, false); }
    // What fills it; null outside, and where nothing does.
    const Medium* medium() const;
    double ior() const { return ior_of(top(-1, 0, true)); }

    static constexpr int capacity = 16;

  private:
    struct Entry {
        int surface = 0, times = 0;
    };
    // The surface that counts when `changed` is entered (step 1) or left (-1) once more; among
    // those that refract, or among all.
    int top(int changed, int step, bool refracting) const;
    double ior_of(int surface) const;

    const SurfaceSet* surfaces_;
    std::array<Entry, capacity> entries_;  // in the order of entering
    int count_ = 0;
};

}  // namespace gischt
