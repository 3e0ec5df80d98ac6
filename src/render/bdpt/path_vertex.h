// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "optics/bsdf.h"
#include "optics/interior.h"
#include "optics/light_emission.h"
#include "optics/medium.h"
#include "render/path/spectral.h"

namespace gischt {

// A vertex of a path that begins at the camera or at a light. Directions are unit vectors that
// point away from it. The contribution of a path is a product from the eye to the light, of
//   the camera's density of film area per solid angle,
//   at each scattering the phase function times albedo and extinction, or f |cos| of Bsdf::value,
//   at each connection transmittance, and per metre^2 |cos| at the end nearer to the light / d^2,
//   and what the light radiates.
struct PathVertex {
    enum class Kind { Camera, Light, Surface, Medium };
    Kind kind = Kind::Camera;
    EmittedLight::Kind light = EmittedLight::Kind::None;  // what kind of light
    int source = -1;                                      // of a light, in LightEmission
    Vec3d point;
    Vec3d back;                      // to the vertex before; of a light at infinity: to the light
    std::optional<SurfaceHit> hit;   // of a surface, seen from the vertex before, or a light
    std::optional<Bsdf> bsdf;        // of a surface, for `back`
    double relative_ior = 1;         // of the far side over that of the near one
    const Medium* medium = nullptr;  // that scatters or glows
    Vec3f albedo;                    // of its scattering
    std::optional<InteriorStack> inside;  // on the near side; where surfaces have insides

    // What the path carries before it is scattered here: contribution over density.
    PathWeight weight;
    int events = 0;  // scatterings before this one, those into single directions left out

    // How the path went on from here.
    bool is_delta = false;  // into a single direction
    double onward = 0;      // density of that direction, 1/sr; 1 for a single one
    double return_ = 0;     // of coming back by it: of `back` for light from there, 1/sr

    // For the weights (strategy_weights.h).
    double density =
        0;  // per area, or volume over extinction, of the vertex; of a light all in all
    double through = 1;  // about the transmittance from the vertex before
    double sampled = 0;  // of the first vertex after a light: density of sampling the light from
                         // here over that of starting there
    double earlier = 0;  // sum of strategies

    bool is_light() const { return kind == Kind::Light; }
    // |cos| to the geometric normal; 1 where there is none.
    double facing(const Vec3d& direction) const {
        return hit ? std::abs(dot(hit->normal, direction)) : 1;
    }
    // Whether two ends can meet here.
    bool can_connect() const {
        return kind == Kind::Medium || (kind == Kind::Surface && !bsdf->is_delta_only());
    }
};

// What scatters towards `eye` of light that comes from `light`: phase function times albedo, or f
// |cos|, in 1/sr.
Vec3f scattering(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& eye,
                 const Vec3d& light);
// The density with which a path that comes from `from` goes on to `to`, 1/sr.
double direction_density(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& from,
                         const Vec3d& to);
// The same as scattering() for a path from a light that came from `light`, per solid angle around
// `eye`: times |cos eye| / |cos light| to the geometric normal (Veach 1997, 5.3.2).
Vec3f adjoint_scattering(const SurfaceSet& surfaces, const PathVertex& v, const Vec3d& eye,
                         const Vec3d& light);

// A subpath goes on. Nothing where it ends.
struct PathTurn {
    Vec3d direction;
    bool is_transmission = false;
};
enum class PathFrom { Camera, Light };
// Draws a direction by numbers of `random`, and notes in the vertex how; `weight` is that with
// which the path goes on.
std::optional<PathTurn> turn_at(const SurfaceSet& surfaces, PathVertex& v, PathFrom from,
                                RandomStream& random, PathWeight& weight);

}  // namespace gischt
