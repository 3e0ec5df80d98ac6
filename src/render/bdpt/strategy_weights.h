// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "render/bdpt/bdpt_scene.h"
#include "render/bdpt/path_vertex.h"

namespace gischt {

// Multiple importance sampling of the ways to find a path of n vertices: s of them by a path from a
// light, n - s by one from the camera, which are connected (Lafortune & Willems 1993; Veach &
// Guibas 1995). s = 0: the camera's path finds the light; s = 1: the light is sampled anew for the
// vertex next to it; one vertex from the camera: light paths shine onto the film. A path is weighed
// by the power heuristic, p_s^2 / sum of p_i^2.
//
// The p_s are densities of the directions, and of the places on lights, alone: a deterministic
// function of the path. What the media do to flights is the same in all of them but for the
// transmittance of the edge that is connected, T_s, by which p_s may be divided (StrategyWeights::
// Distances).
//
// With r_i = (density of vertex i by the other end) / (by its own), of the first i + 1 vertices of
// a subpath the strategies that connect before vertex i + 1 have, relative to that they were all
// sampled from this end,
//   S(0) = [the light can be found],
//   S(i) = [edge (i - 1, i) can be connected] / T^2 + r_(i-1)^2 S(i - 1);
// the camera, which no path finds, starts with S(0) = 0.
double power_heuristic(double ratio);

// S(i) of the last vertex of `path`, light coming back by `back_density` (1/sr) along its `back`.
// `is_end`: as an end that is connected, not as the vertex by which the path went on.
double strategies_before(const BdptScene& scene, std::span<const PathVertex> path,
                         double back_density, bool is_end);

// Density per area (or volume over extinction) at `to`, of a direction from a point at the square
// of a distance.
inline double density_at(const PathVertex& to, const Vec3d& from_there, double direction_density,
                         double distance2) {
    return direction_density * to.facing(from_there) / distance2;
}

// The end of a path at a light, as it is found from the vertex next to it.
struct LightEnd {
    EmittedLight::Kind kind = EmittedLight::Kind::None;
    Vec3d direction;        // from the vertex to the light
    double distance = 0;    // finite lights
    double facing = 1;      // |cos| at a surface
    double sampled = 0;     // density of sampling it from the vertex: per sr, of media per m^3
    bool is_delta = false;  // cannot be found by chance: `sampled` is a probability
    LightEmission::Densities emitted;  // place 0 where no light path starts there
};

// All strategies of a path that ends at a light, relative to the density with which the camera's
// path finds the light (0 where it cannot, see is_delta): p_0, p_1 and the sum over the rest.
// `camera` ends with the vertex next to the light; `found` is its density (1/sr) of the direction
// to the light, `through` about the transmittance of the edge.
struct LightEndStrategies {
    double found = 0, sampled = 0, rest = 0;  // squares, in one unit
    double sum() const { return found + sampled + rest; }
};
LightEndStrategies strategies_at(const BdptScene& scene, std::span<const PathVertex> camera,
                                 const LightEnd& light, double found, double through,
                                 double back_density, bool is_end);

}  // namespace gischt
