// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "optics/light.h"
#include "optics/surface.h"

namespace gischt {

// A surface of finite size that glows: directions towards it are drawn evenly over the solid angle
// that it fills (sphere, box, rectangle) or over its area (disc); a mesh by a triangle in
// proportion to area, and evenly over that one's solid angle. It may hide itself and be hidden:
// whoever draws a sample tests that. The distance of a sample ends a little before the surface, so
// that the surface does not block the test.
class SurfaceLight : public Light {
  public:
    // Which of the SurfaceSet.
    int surface() const { return surface_; }
    // The density in 1/sr with which sample() from a point takes the direction to a hit of this
    // surface.
    virtual float pdf_of_hit(const Vec3d& from, const SurfaceHit& hit) const = 0;
    // W, over both sides where both shine.
    virtual double power() const = 0;

    // A point drawn evenly over the area (that of one side), for u in [0,1)^2.
    struct AreaPoint {
        Vec3d point, normal;  // the normal points to the outer side
        int primitive = 0;    // as in SurfaceHit
        double offset = 0;    // as in SurfaceHit, m
    };
    virtual AreaPoint area_point(Vec2f u) const = 0;
    virtual double area() const = 0;  // m^2, of one side
    // It encloses a space, into which its inner side shines; power() leaves that out.
    virtual bool is_closed() const { return false; }
    const Vec3f& emission() const { return emission_; }

    Vec3f radiance(const Vec3d&) const override { return {}; }
    bool is_delta() const override { return false; }
    bool is_infinite() const override { return false; }

  protected:
    int surface_ = -1;
    Vec3f emission_;  // W/(m^2 sr)
};

// The lights among the surfaces.
std::vector<std::shared_ptr<const SurfaceLight>> make_surface_lights(
    const SurfaceSet::Content& content);

}  // namespace gischt
