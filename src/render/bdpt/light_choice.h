// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/bdpt/bdpt_scene.h"
#include "render/bdpt/path_vertex.h"
#include "render/bdpt/strategy_weights.h"

namespace gischt {

// Lights as the ends of paths: each with the densities by which it is sampled from the vertex next
// to it, and by which light paths start there.

// A point of a surface that glows, seen from `from`.
LightEnd surface_end(const BdptScene& scene, const SurfaceHit& hit, const Vec3d& from);
// A light at infinity, met from `from` in a direction.
LightEnd far_end(const BdptScene& scene, const Light& light, const Vec3d& from,
                 const Vec3d& direction);
// A point of a medium that glows.
LightEnd glow_end(const BdptScene& scene, const Medium& medium, const Vec3d& point,
                  const Vec3d& from);
// A light without size at a finite place.
LightEnd point_end(const BdptScene& scene, const Light& light, const Vec3d& place,
                   const Vec3d& from);
// The start of a light path.
LightEnd light_end_of(const BdptScene& scene, const PathVertex& light, const Vec3d& from);

// A light drawn for a vertex at a point.
struct DrawnLight {
    const Light* light = nullptr;  // null: none was drawn, or a medium
    const Medium* medium = nullptr;
    LightSample sample;  // of a medium: where to, and emission / density / d^2; pdf unused
    float share = 0;     // probability of the light
};
// One of the lights at finite places, by how brightly it would shine there without shadow.
DrawnLight draw_local(const BdptScene& scene, const Vec3d& point, RandomStream& random);
// One of the lights at infinity that have a direction density.
DrawnLight draw_broad(const BdptScene& scene, const Vec3d& point, RandomStream& random);
// A point of a medium that glows.
DrawnLight draw_glow(const BdptScene& scene, const Vec3d& point, RandomStream& random);

}  // namespace gischt
