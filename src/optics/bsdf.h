// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "math/vec.h"
#include "optics/bsdf_lobes.h"

namespace gischt {

// How a surface scatters light at one point: a scattering function in the frame of the shading
// normal. All directions are unit vectors in the scene's frame that point away from the surface:
// `out` to where the light goes (the viewer), `in` to where it comes from. `out` lies on the side
// of the geometric normal given.
//
// Radiance counts as L / n^2 (basic radiance, Nicodemus 1963), n being the index of refraction
// where it is: it stays the same through a lossless refraction, so that no weight exceeds 1, and
// between places in vacuum it is radiance.
//
// Reflection and transmission are told apart by the geometric normal: what the shading normal alone
// would send through an opaque surface is lost, so that no light leaks (Veach 1997, 5.3).
class Bsdf {
  public:
    Bsdf(const Vec3d& normal, const Vec3d& shading_normal, const BsdfLobe& lobe);

    // f |cos| in 1/sr, without delta lobes.
    Vec3f value(const Vec3d& out, const Vec3d& in) const;
    // The density in 1/sr with which sample() takes a direction, without delta lobes.
    float pdf(const Vec3d& out, const Vec3d& in) const;
    // Nothing where the sample would carry no light.
    std::optional<BsdfSample> sample(const Vec3d& out, Vec2f u, float u_lobe) const;
    // All scattering is into single directions: value() is always 0.
    bool is_delta_only() const;
    // About the share of light that is scattered at all; for denoisers and for choices, not exact.
    Vec3f albedo_estimate(const Vec3d& out) const;

  private:
    Vec3d to_local(const Vec3d& v) const { return {dot(v, s_), dot(v, t_), dot(v, n_)}; }
    double shadow_terminator(const Vec3d& in) const;

    Vec3d s_, t_, n_;  // frame of the shading normal n
    Vec3d normal_;     // of the geometry
    BsdfLobe lobe_;
};

// The shading normal nearest to the wish at which a mirror reflects `out` to the side of the
// geometric normal: no fringes that are black because a reflection runs into the surface (Keller et
// al. 2017, "The Iray light transport simulation and rendering system", A.3). Unit vectors;
// dot(out, normal) > 0.
Vec3d valid_shading_normal(const Vec3d& wish, const Vec3d& normal, const Vec3d& out);

}  // namespace gischt
