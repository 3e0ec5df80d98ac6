// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "math/keyframes.h"
#include "math/vec.h"
#include "optics/medium_params.h"

namespace gischt {

enum class MaterialKind {
    Lambert,     // scatters light evenly
    Conductor,   // reflects, smooth or rough: a metal
    Dielectric,  // reflects and refracts, smooth or rough: glass, water
    Plastic,     // a clear coat over an even colour
    None,        // not seen at all: the boundary of what fills it
};

// Metals with their published indices of refraction.
enum class Metal { Gold, Copper, Aluminium, Silver, Iron, Chrome };

// A picture that multiplies albedo or color, repeated over the surface's coordinates.
struct TextureParams {
    std::string file;
    Vec2d repeat{1, 1};  // times per unit of the surface's coordinates
};

// What a surface does to light, and what lies behind it.
struct Material {
    MaterialKind kind = MaterialKind::Lambert;
    // Lambert, plastic: share of light reflected, in [0,1]. Unset: what the file of a mesh says,
    // else 0.5.
    std::optional<Vec3d> albedo;
    Vec3d checker{0.5, 0.5, 0.5};  // albedo of every other field of a checker board
    double checker_size = 0;       // m, edge of a field; 0: no checker board
    std::optional<TextureParams> texture;
    Keyed<Vec3d> emission{Vec3d{0, 0, 0}};  // W/(m^2 sr)

    double roughness = 0;        // the width of the microfacet lobe is its square (Burley 2012)
    double ior = 1.5;            // dielectric, plastic: index of refraction inside
    std::optional<Metal> metal;  // conductor; unset: `color`
    // Conductor: reflectance at normal incidence. Dielectric: share of the light that passes at
    // each crossing beside the loss by reflection. Unset: 1, for a conductor 0.9.
    std::optional<Vec3d> color;

    // What fills the inside of a dielectric or of a boundary without a surface: a fluid of the
    // scene by name, or a homogeneous medium.
    std::string interior;
    std::optional<MediumParams> medium;
    int priority = 0;  // where insides overlap, the highest counts; then the later in the scene

    bool holdout = false;         // seen by the camera as a hole in the picture
    bool shadow_catcher = false;  // seen by the camera only by the shadows on it
    bool camera_visible = true;   // whether camera rays see it; light always does
};

}  // namespace gischt
